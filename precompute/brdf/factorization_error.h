// How far K terms are from the BRDF that they stand for, after each term.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/scene/factored_brdf.h"
#include "precompute/brdf/tabulation.h"

#include <span>
#include <vector>

namespace relume {

// ‖M - M̃‖ / ‖M‖ (Frobenius) over the texel centers, unweighted, mean over channels. `layer` is the table's
// own.
std::vector<float> frobeniusResiduals(const BrdfTable& table, const FactoredBrdf& factored, int layer = 0);

// Relative RMS of reflected radiance that is to be expected of unshadowed points under environments in
// general, in the pixels of a convex object: sqrt(Σ ‖Y (M - M̃) Q‖² / Σ ‖Y M Q‖²) over channels, Y and Q of
// light_metric.h.
std::vector<float> expectedErrors(const BrdfTable& table, const FactoredBrdf& factored, int layer = 0);
// That of every layer, whose tables these are.
std::vector<std::vector<float>> expectedErrors(std::span<const BrdfTable> tables,
                                               const FactoredBrdf& factored);

// sqrt(mean (f̃ - f)² cos²θi cos²θo) over `pairs` random pairs of directions, uniform on the hemisphere, as
// bilinear lookups return f̃, and that over the same of f; means over channels. The sum of `layers` layers
// from `layer` on is held against f.
struct RmsErrors {
    std::vector<float> absolute, relative;
};
RmsErrors rmsErrors(const Brdf& brdf, const FactoredBrdf& factored, int layer = 0, int layers = 1,
                    int pairs = 80000);

// Measured: the relative RMS of the radiance that unshadowed points reflect, over `orientations` of the frame
// turned every way in the light and 40 views of each, as the pixels of a convex object have them (density
// cosθ) or, with `uniform`, with equal density over the hemisphere. Sums over the cube's texels; negative
// sums count as 0, as they are drawn.
struct RadianceErrorOptions {
    int orientations = 60;
    bool uniform = false;
};
struct LayerOf {
    const FactoredBrdf* factored;
    int layer = 0;
};
// After each term, per factored BRDF.
std::vector<std::vector<float>> radianceErrors(const Brdf& brdf, std::span<const LayerOf> factored,
                                               const LightCube& light,
                                               const RadianceErrorOptions& options = {});
// That per light, all lights of one size: the BRDF is evaluated once for all of them.
std::vector<std::vector<std::vector<float>>> radianceErrors(const Brdf& brdf,
                                                            std::span<const LayerOf> factored,
                                                            std::span<const LightCube> lights,
                                                            const RadianceErrorOptions& options = {});

} // namespace relume

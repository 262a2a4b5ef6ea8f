// Errors of a factored BRDF against the exact one, after each number of terms.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/scene/factored_brdf.h"

#include <span>
#include <vector>

namespace relume {

class Brdf;       // brdf.h
struct BrdfTable; // tabulation.h

// Returns, after each term, ‖M - M̃‖ / ‖M‖ (Frobenius, mean over channels) at the texel centers, unweighted.
// `layer` is that of the table.
std::vector<float> frobeniusResiduals(const BrdfTable& table, const FactoredBrdf& factored, int layer = 0);

// Returns, after each term, the expected relative RMS error of the reflected radiance of unshadowed points,
// over environments in general and the pixels of a convex object: sqrt(Σ ‖Y (M - M̃) Q‖² / Σ ‖Y M Q‖²) over
// channels, with Y and Q of light_metric.h.
std::vector<float> expectedErrors(const BrdfTable& table, const FactoredBrdf& factored, int layer = 0);
// Returns these errors for every layer; `tables` has the table of each.
std::vector<std::vector<float>> expectedErrors(std::span<const BrdfTable> tables,
                                               const FactoredBrdf& factored);

// Errors after each term over `pairs` random pairs of directions, uniform on the hemisphere, with f̃ by
// bilinear lookups; means over channels. Absolute: sqrt(mean (f̃ - f)² cos²θi cos²θo). Relative: divided by
// the same root mean of f. f̃ is the sum of `layers` layers from `layer` on.
struct RmsErrors {
    std::vector<float> absolute, relative;
};
RmsErrors rmsErrors(const Brdf& brdf, const FactoredBrdf& factored, int layer = 0, int layers = 1,
                    int pairs = 80000);

// Options of radianceErrors(), which measures the relative RMS error of the radiance of unshadowed points:
// over `orientations` random rotations of the frame against the light and 40 views of each. Views have the
// density of the pixels of a convex object (cosθ) or, if `uniform`, of the hemisphere. Integrals are sums
// over the cube's texels; negative ones count as 0, as when drawn.
struct RadianceErrorOptions {
    int orientations = 60;
    bool uniform = false;
};
// A layer of a factored BRDF.
struct LayerOf {
    const FactoredBrdf* factored;
    int layer = 0;
};
// Returns the errors after each term, per factored BRDF.
std::vector<std::vector<float>> radianceErrors(const Brdf& brdf, std::span<const LayerOf> factored,
                                               const LightCube& light,
                                               const RadianceErrorOptions& options = {});
// Returns these errors per light. All lights have one size; the BRDF is evaluated once for all of them.
std::vector<std::vector<std::vector<float>>> radianceErrors(const Brdf& brdf,
                                                            std::span<const LayerOf> factored,
                                                            std::span<const LightCube> lights,
                                                            const RadianceErrorOptions& options = {});

} // namespace relume

// Predicts the error of images for many K and N from a sample of points, without a bake.
#pragma once

#include "engine/scene/residual.h"
#include "precompute/error/stage_radiance.h"

namespace relume {

// Points seen from one eye; RayHit::mesh is the part.
struct SeenPoints {
    vec3 eye;
    std::vector<RayHit> hits;
};

// Returns their radiance in order: that of the exact BRDF and the full mesh under 6 × kTruthFaceSize² texels
// of light, with one ray each. Uses all cores.
std::vector<vec3> exactRadiance(const Asset& asset, const Appearance& appearance,
                                std::span<const SeenPoints> points, const LightCube& fine,
                                const std::function<void(double)>& progress = {});

// The N that are tried, ascending; the last keeps all coefficients.
constexpr std::array<int, 16> kTriedCoefficients = {8,   12,  16,  24,  32,  48,  64,   96,
                                                    128, 192, 256, 384, 512, 768, 1536, 6 * 64 * 64};

// Predicted errors of transport in rows, without quantization.
struct ErrorGrid {
    int terms = 0;    // of the part with most terms
    double level = 0; // RMS of the exact radiance
    // RMS error relative to `level`, for K = term + 1, by term and tried N.
    std::vector<std::array<double, kTriedCoefficients.size()>> errors;
    // Per part and term, by tried N: row entries that remain nonzero after quantization, mean over sampled
    // vertices.
    std::vector<std::vector<std::array<double, kTriedCoefficients.size()>>> entries;
    std::vector<double> shares; // per part: share of the points
};

// Returns the grid of an asset with meshes, occluder and materials factored into the most terms to be tried;
// its transport is not used. Factors must be nested, that is, the first K terms those of a factorization into
// K (Factorization::NonNegative's are not). Parts whose set has a residual are drawn with it. `exact` is the
// radiance of the points. Uses all cores; the same input gives the same grid. Throws Error if `exact` is
// black.
ErrorGrid errorGrid(const Asset& asset, const Appearance& appearance, std::span<const SeenPoints> points,
                    std::span<const vec3> exact, const DrawnLight& light,
                    const std::function<void(double)>& progress = {});

} // namespace relume

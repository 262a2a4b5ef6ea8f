// What error images would have, over K and N, predicted from a sample of points without a bake.
#pragma once

#include "engine/scene/residual.h"
#include "precompute/error/stage_radiance.h"

namespace relume {

// Points that one eye sees: RayHit::mesh is the part.
struct SeenPoints {
    vec3 eye;
    std::vector<RayHit> hits;
};

// Their radiance, one eye's after another's: the exact BRDF and the full mesh under 6 × kTruthFaceSize²
// texels of light, a ray each. On all cores.
std::vector<vec3> exactRadiance(const Asset& asset, const Appearance& appearance,
                                std::span<const SeenPoints> points, const LightCube& fine,
                                const std::function<void(double)>& progress = {});

// N that are tried, rising; the last stands for all.
constexpr std::array<int, 16> kTriedCoefficients = {8,   12,  16,  24,  32,  48,  64,   96,
                                                    128, 192, 256, 384, 512, 768, 1536, 6 * 64 * 64};

// Transport in rows, before quantization.
struct ErrorGrid {
    int terms = 0;    // of the part with most
    double level = 0; // root mean square of the exact radiance
    // Root mean square against it, relative to that, of K = term + 1, by term and tried N.
    std::vector<std::array<double, kTriedCoefficients.size()>> errors;
    // Per part and term, by tried N: entries of a row that quantization leaves, mean over sampled vertices.
    std::vector<std::vector<std::array<double, kTriedCoefficients.size()>>> entries;
    std::vector<double> shares; // of the points, per part
};

// The light of a grid: its selected entries, and the cube that they are selected from.
struct GridLight {
    LightVector drawn;
    LightCube cube; // F texels a side
};

// `asset` has meshes, occluder and factored materials, those of the most terms to be tried; its transport is
// not looked at. Parts and sets that have a residual are drawn with it. Throws Error where `exact` is black.
// Factors are nested: the first K terms are those of a factorization into K (Factorization::NonNegative's are
// not). `exact`: of the points. On all cores; the same input gives the same grid.
ErrorGrid errorGrid(const Asset& asset, const Appearance& appearance, std::span<const SeenPoints> points,
                    std::span<const vec3> exact, const GridLight& light,
                    const std::function<void(double)>& progress = {});

} // namespace relume

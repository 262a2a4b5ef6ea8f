// The residual of a BRDF: kernels for its exact, unshadowed reflection, which pixels combine with the
// shadowed K terms (docs/residual.md).
#pragma once

#include "engine/math/vector.h"
#include "shaders/shared/sphere.h"

#include <memory>
#include <vector>

namespace relume {

// A BRDF's unshadowed reflection as a convolution in azimuth. Light is given in polar coordinates (ρ', φ')
// about the direction to the eye. A surface whose mirror direction is (ρ, φ), and in whose tangent frame the
// eye is at azimuth a, reflects the radiance
//
//     E(ρ, φ; a) = Re Σ_c Σ_m e^(i (mφ + 2ca)) Σ_ρ' values[c, m][ρ, ρ'] Σ_φ' L(ρ', φ') e^(-imφ')
//
// where L is radiance times solid angle. Turning the light about the view direction turns the reflection with
// it, so that only rings mix. Components (c, m) are in this order: harmonic 0 with frequencies 0 to M, then
// harmonics 1 to H, each with frequencies -M to M. Isotropic BRDFs have H = 0. Values are real because the
// BRDF is mirror-symmetric.
struct SphereKernel {
    int frequencies = 0;      // M, at most kMostFrequencies
    int harmonics = 0;        // H, at most kMostHarmonics
    std::vector<vec3> values; // [component][ring of the mirror direction][ring of the light]

    int components() const { return frequencies + 1 + harmonics * (2 * frequencies + 1); }
    size_t valueCount() const { return size_t(components()) * shared::kSphereRings * shared::kSphereRings; }
};

// Returns how concentrated the reflection is for a surface that faces the eye: the kernel's largest value
// divided by its mean over all light directions, at least 1. About 4 for a diffuse BRDF, hundreds for a
// polished one.
float concentrationOf(const SphereKernel& kernel);

// The residual of a set of materials.
struct ResidualSet {
    // One kernel per layer of the set's view maps.
    std::vector<std::shared_ptr<const SphereKernel>> layers;
    // Whether no texel of the light and view maps is negative, so that ratios of their sums are safe.
    bool hasNonnegativeTerms = false;
    // Whether tuples include light from other surfaces, which the unshadowed radiance does not bound.
    bool isBounced = false;
    // The weights a_k, per channel. Σ a_k g_k is as near to 1 as the light maps allow, in least squares over
    // the hemisphere weighted by the cosine, so that Σ a_k γ_k approximates the irradiance of a point.
    std::vector<vec3> irradianceWeights;
};

} // namespace relume

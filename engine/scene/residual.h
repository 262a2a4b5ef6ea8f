// The residual of a BRDF: kernels that give its exact, unshadowed reflection, which pixels combine with the
// shadowed K terms (docs/residual.md).
#pragma once

#include "engine/math/vector.h"
#include "shaders/shared/sphere.h"

#include <memory>
#include <vector>

namespace relume {

// A BRDF as a convolution. With the light in polar coordinates about the direction towards the eye, (ρ', φ'),
// the radiance that a surface reflects whose mirror direction is (ρ, φ), and in whose tangent frame the eye
// is at azimuth a, is
//
//     E(ρ, φ; a) = Re Σ_c Σ_m e^(i (mφ + 2ca)) Σ_ρ' values[c, m][ρ, ρ'] Σ_φ' L(ρ', φ') e^(-imφ')
//
// where L is radiance times solid angle: a turn about the view direction turns a reflection along, so that
// only rings mix. Components (c, m) in order: harmonic 0 with frequencies 0 to M, then harmonics 1 to H, each
// with frequencies -M to M. Isotropic BRDFs have H = 0. That values are real takes mirror symmetry of the
// BRDF.
struct SphereKernel {
    int frequencies = 0;      // M, at most kMostFrequencies
    int harmonics = 0;        // H, at most kMostHarmonics
    std::vector<vec3> values; // [component][ring of the mirror direction][ring of the light]

    int components() const { return frequencies + 1 + harmonics * (2 * frequencies + 1); }
    size_t valueCount() const { return size_t(components()) * shared::kSphereRings * shared::kSphereRings; }
};

// Returns the largest value of the kernel of a surface that faces the eye, over the mean of all directions:
// how much brighter one light can make it than even light of the same energy. 4 of a diffuse one, hundreds of
// a polished one.
float concentrationOf(const SphereKernel& kernel);

// The residual of a set of materials.
struct ResidualSet {
    // One kernel per layer of the set's view maps.
    std::vector<std::shared_ptr<const SphereKernel>> layers;
    // Neither light nor view maps are negative anywhere: ratios of their sums are safe.
    bool hasNonnegativeTerms = false;
    // The tuples have light of other surfaces, too, which what nothing shadows does not bound.
    bool isBounced = false;
    // a_k per channel: Σ a_k g_k is as near to 1 as light maps come, in least squares over the hemisphere
    // weighted by the cosine. So Σ a_k γ_k is the irradiance of a point.
    std::vector<vec3> irradianceWeights;
};

} // namespace relume

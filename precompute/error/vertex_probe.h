// Explains the color of one vertex.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/render/appearance.h"
#include "precompute/cpu/cpu_visibility.h"

namespace relume {

// F is the asset's faceSize, K the number of terms of the bound set. Transport includes solid angles, so
// radiance is Σ over texels of transport · mean radiance of the texel.
struct VertexProbe {
    // 6 · F²: share of the visibility texels in each lighting texel that are unoccluded and above the
    // horizon.
    std::vector<float> visibility;
    std::vector<vec3> tuple; // K: as relight() computes it, up to rounding
    std::vector<vec3> views; // K: view maps of the bound layers towards the eye, times layer weights, summed
    LightCube transport;     // Σ over terms of views · transport, as stored in the asset; can be negative
    vec3 radiance;           // Σ views · tuple: as drawn, but not clamped at zero
    vec3 fullRadiance; // Σ transport · light: under the whole light, without selection or quantization
};

// `occluder` traces the asset's occluder at its visibilitySize; rays start where those of the bake do.
// `lightVector` is made from `light`; both have F texels per side of a face.
VertexProbe probeVertex(const Asset& asset, const CpuVisibility& occluder, size_t part, uint32_t vertex,
                        vec3 eye, const PartAppearance& appearance, const LightCube& light,
                        const LightVector& lightVector);

} // namespace relume

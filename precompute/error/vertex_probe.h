// Everything that explains the color of one vertex.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/render/appearance.h"
#include "precompute/cpu/cpu_visibility.h"

namespace relume {

// F is the asset's faceSize, K the terms of the bound set. Solid angles are in the transport, so that a
// radiance is Σ over texels of transport · mean radiance of the texel.
struct VertexProbe {
    // 6 · F²: share of the visibility texels in a lighting texel that are free and above the horizon.
    std::vector<float> visibility;
    std::vector<vec3> tuple; // K: light-modulated, as relight() gives it but for rounding
    std::vector<vec3>
        views;           // K: of the bound layers, seen from the eye: view maps times layer weights, summed
    LightCube transport; // Σ over terms of views · transport, as the asset keeps it; can be negative
    vec3 radiance;       // Σ views · tuple: what is drawn, but not clamped at zero
    vec3 fullRadiance;   // Σ transport · light: the same under all of the light, nothing dropped or rounded
};

// `occluder` traces the asset's occluder at its visibilitySize; rays start where the bake's do. `lightVector`
// is made of `light`; both have F texels a side.
VertexProbe probeVertex(const Asset& asset, const CpuVisibility& occluder, size_t part, uint32_t vertex,
                        vec3 eye, const PartAppearance& appearance, const LightCube& light,
                        const LightVector& lightVector);

} // namespace relume

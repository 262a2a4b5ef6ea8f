// Images by ray tracing with the exact BRDF and exact visibility: what a relit image is held against.
#pragma once

#include "engine/image/image.h"
#include "engine/light/light_cube.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"

#include <functional>

namespace relume {

enum class ReferenceBrdf { Exact, Factored };

struct ReferenceOptions {
    int width = 640, height = 480;
    ReferenceBrdf brdf = ReferenceBrdf::Exact;
    int raysPerTexelSide = 2;   // shadow rays through each lighting texel: this squared; 4 is the 256² grid
    bool bakedOccluder = false; // cast shadows with the asset's simplified occluder, not the full mesh
};

// Shades every pixel that sees the asset by summing over all texels of `light` above its horizon: radiance ·
// BRDF · cosine · solid angle · visible fraction. Normals and positions are interpolated as in
// the view pass; the eye sees the asset only where its pixel centre does. Several threads.
// `progress` is called with the number of finished rows, from one thread at a time.
Image renderReference(const Asset& asset, const Camera& camera, const LightCube& light,
                      const ReferenceOptions& options, const std::function<void(int)>& progress = {});

// The same under the full-resolution environment, turned by `rotation`: every pixel of the map (after
// area-averaging to `maxWidth` columns) is a light of its own.
Image renderReference(const Asset& asset, const Camera& camera, const Environment& environment,
                      float rotation, int maxWidth, const ReferenceOptions& options,
                      const std::function<void(int)>& progress = {});

} // namespace relume

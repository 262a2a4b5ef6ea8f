// Ray-traced images with exact BRDF and visibility: the reference for relit images.
#pragma once

#include "engine/image/image.h"
#include "engine/light/light_cube.h"
#include "engine/render/ground_fade.h"
#include "engine/render/pixel_samples.h"
#include "engine/scene/camera.h"
#include "precompute/reference/bound_brdf.h"

#include <functional>

namespace relume {

struct ReferenceOptions {
    int width = 640, height = 480;
    int samples = kDefaultSamples; // per pixel, placed as in the view pass: 1, 2, 4 or 8
    ReferenceBrdf brdf = ReferenceBrdf::Exact;
    int raysPerTexelSide = 2;   // squared: shadow rays through each lighting texel; 4 is the 256² grid
    Appearance appearance = {}; // materials bound to parts; empty: the default appearance
    std::optional<GroundFade> groundFade = std::nullopt;
    // Reflections between surfaces before the last one towards the eye, and the number of paths per pixel
    // that sample them; noise falls with its square root. None: as many bounces as the asset's transport has,
    // with the exact BRDF only.
    std::optional<int> bounces = std::nullopt;
    int paths = 256;
    bool bakedOccluder = false; // cast shadows by the asset's simplified occluder, not the full mesh
};

// Offset of shadow rays above the surface, in scene radii, if the full mesh is the occluder. With the baked
// occluder it is Asset::visibilityOffset, as in the bake.
constexpr float kFullMeshShadowOffset = 1e-4f;

// Shades every pixel that shows the asset by summing radiance · BRDF · cosine · solid angle over all texels
// of `light` above its horizon, with BRDF and visibility evaluated for each of a texel's shadow rays. Normals
// and positions are interpolated as in the view pass; each triangle in a pixel is shaded once, at the mean of
// its samples' hits. Radiance is premultiplied by alpha, the share of samples that hit the asset. A ray above
// the interpolated horizon but below the triangle's plane hits the mesh. Bounced light is sampled
// (path_sampling.h), nothing else is. Multithreaded; the same input gives the same image. `progress` is
// called with the number of finished rows, from one thread at a time.
Image renderReference(const Asset& asset, const Camera& camera, const LightCube& light,
                      const ReferenceOptions& options, const std::function<void(int)>& progress = {});

// Renders under the full-resolution environment, rotated by `rotation` radians: every pixel of
// prepareForSampling(environment, maxWidth) is a light of its own, with one shadow ray.
Image renderReference(const Asset& asset, const Camera& camera, const Environment& environment,
                      float rotation, int maxWidth, const ReferenceOptions& options,
                      const std::function<void(int)>& progress = {});

} // namespace relume

// Images by ray tracing with the exact BRDF and exact visibility: what a relit image is held against.
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
    int samples = kDefaultSamples; // a pixel, where the view pass has them: 1, 2, 4 or 8
    ReferenceBrdf brdf = ReferenceBrdf::Exact;
    int raysPerTexelSide = 2;   // shadow rays through each lighting texel: this squared; 4 is the 256² grid
    Appearance appearance = {}; // what parts wear; empty: the default appearance
    std::optional<GroundFade> groundFade = std::nullopt;
    // Reflections between surfaces, besides the last towards the eye, and paths a pixel that they are traced
    // by; their noise falls with the square root of these. None: as many as the asset's transport has, of the
    // exact BRDF; others have no bounced light.
    std::optional<int> bounces = std::nullopt;
    int paths = 256;
    bool bakedOccluder = false; // cast shadows with the asset's simplified occluder, not the full mesh
};

// With the full mesh as occluder, shadow rays start this far above the surface, in scene radii. With the
// baked one they start where the bake's do, at Asset::visibilityOffset.
constexpr float kFullMeshShadowOffset = 1e-4f;

// Shades every pixel that sees the asset by summing over all texels of `light` above its horizon: radiance ·
// BRDF · cosine · solid angle, with BRDF and visibility taken anew for each of the texel's shadow rays.
// Normals and positions are interpolated as in the view pass, the frame is of the interpolated normal and
// tangent; the eye sees what a pixel's samples see, each triangle shaded once, at the mean of where they meet
// it. Radiance is premultiplied by alpha, the share of samples that see the asset. Several threads; the same
// input gives the same image. Facets are real: a ray above the interpolated horizon but below its triangle's
// plane meets the mesh. Bounced light is sampled (path_sampling.h), everything else is not. `progress` is
// called with the number of finished rows, from one thread at a time.
Image renderReference(const Asset& asset, const Camera& camera, const LightCube& light,
                      const ReferenceOptions& options, const std::function<void(int)>& progress = {});

// The same under the full-resolution environment, turned by `rotation`: every pixel of
// prepareForSampling(environment, maxWidth) is a light of its own, with one shadow ray.
Image renderReference(const Asset& asset, const Camera& camera, const Environment& environment,
                      float rotation, int maxWidth, const ReferenceOptions& options,
                      const std::function<void(int)>& progress = {});

} // namespace relume

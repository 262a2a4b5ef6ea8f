// The hits of a pixel's samples.
#pragma once

#include "engine/render/pixel_samples.h"
#include "engine/scene/camera.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// The hit of every sample of a pixel of an image of this size, hits.size() samples; none: it sees nothing.
// Hits of the same triangle are one point: the mean of where its samples meet it.
void findPixelHits(const RayTracer& surfaces, const Camera& camera, ivec2 pixel, ivec2 size,
                   std::span<std::optional<RayHit>> hits);

inline bool isSameTriangle(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
    return a && b && a->mesh == b->mesh && a->triangle == b->triangle;
}

} // namespace relume

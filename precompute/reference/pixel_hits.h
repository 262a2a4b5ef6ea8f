// Finds the ray hits of a pixel's samples.
#pragma once

#include "engine/render/pixel_samples.h"
#include "engine/scene/camera.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Finds the hit of each of a pixel's hits.size() samples, or none. Hits of the same triangle are replaced by
// their mean.
void findPixelHits(const RayTracer& surfaces, const Camera& camera, ivec2 pixel, ivec2 size,
                   std::span<std::optional<RayHit>> hits);

inline bool isSameTriangle(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
    return a && b && a->mesh == b->mesh && a->triangle == b->triangle;
}

} // namespace relume

// Finds the ray hits of a pixel's samples.
#pragma once

#include "engine/render/ground_fade.h"
#include "engine/render/pixel_samples.h"
#include "engine/scene/camera.h"
#include "precompute/visibility/ray_tracer.h"

#include <memory>

namespace relume {

// Finds the hit of each of a pixel's hits.size() samples, or none. Hits of the same triangle are replaced by
// their mean.
void findPixelHits(const RayTracer& surfaces, const Camera& camera, ivec2 pixel, ivec2 size,
                   std::span<std::optional<RayHit>> hits);

// Returns a tracer of these meshes without a ground that is hidden from the eye, or null if all are seen. The
// numbers of meshes stay.
std::unique_ptr<RayTracer> tracerWithout(const std::optional<GroundFade>& ground, vec3 eye,
                                         std::vector<const Mesh*> meshes);

inline bool isSameTriangle(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
    return a && b && a->mesh == b->mesh && a->triangle == b->triangle;
}

} // namespace relume

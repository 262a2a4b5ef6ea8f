// The mesh that casts shadows: the scene's triangles, simplified on request.
#pragma once

#include "engine/import/scene.h"

namespace relume {

struct Occluder {
    Mesh mesh; // positions and triangles only
    // Distance by which simplification moved the surface, in world units: meshoptimizer's estimate (the
    // largest quadric error of a collapse), which some places can exceed.
    float error = 0;
};

constexpr size_t kLeastOccluderTriangles = 4; // of a budget

// Merges the triangles of all parts. If they exceed `triangleBudget` (0: no limit), parts are simplified with
// meshoptimizer, each to its share. Flat convex parts (the ground) are always reduced to the fewest triangles
// that cover them.
Occluder makeOccluder(const Scene& scene, size_t triangleBudget);

// Returns the distance by which a vertex is lifted along its normal before visibility is computed: the error
// of a simplified occluder, and at least 1e-4 of the scene's radius. A convex object stays unshadowed, since
// no part of it rises above a lifted tangent plane.
float visibilityOffset(const Occluder& occluder, const Bounds& scene);

} // namespace relume

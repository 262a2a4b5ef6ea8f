// What casts shadows: the scene's triangles, simplified on request.
#pragma once

#include "engine/import/scene.h"

namespace relume {

struct Occluder {
    Mesh mesh; // Positions and triangles only.
    // Distance that simplification moved the surface by, in world units: meshoptimizer's estimate (the
    // largest quadric error of a collapse), which single places can exceed.
    float error = 0;
};

// All parts' triangles as one mesh; those above `triangleBudget` are simplified with meshoptimizer
// (0: never), each to its share of the budget. Flat convex parts (the ground) always become the fewest
// triangles that cover them exactly.
Occluder makeOccluder(const Scene& scene, size_t triangleBudget);

// How far a vertex is lifted along its normal before visibility is taken: enough to clear a simplified
// occluder, and never less than 1e-4 of the scene's radius. A convex object stays unshadowed: no part
// of it rises above a lifted tangent plane.
float visibilityOffset(const Occluder& occluder, const Bounds& scene);

} // namespace relume

// What casts shadows: the scene's triangles, simplified on request.
#pragma once

#include "engine/scene/scene.h"

namespace relume {

struct Occluder {
    Mesh mesh;       // Positions and triangles only.
    float error = 0; // Largest distance that simplification moved the surface by, in world units.
};

// All parts' triangles as one mesh; those above `triangleBudget` are simplified with meshoptimizer
// (0: never). Flat parts (the ground) simplify to a few triangles at no error.
Occluder makeOccluder(const Scene& scene, size_t triangleBudget);

// How far a vertex is lifted along its normal before visibility is taken: enough to clear a simplified
// occluder, and never less than 1e-4 of the scene's radius. A convex object stays unshadowed: no part
// of it rises above a lifted tangent plane.
float visibilityOffset(const Occluder& occluder, const Bounds& scene);

} // namespace relume

// The diffuse ground under an object: a tessellated square at the object's lowest point.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

struct GroundOptions {
    int tessellation = 148; // quads a side: 149² = 22,201 vertices, the paper's ground for the bunny
    float extent = 3.0f;    // side, in multiples of the object's largest extent along an axis
    bool isStart = false;   // whether refinement may add vertices: the tessellation was not asked for
};

// Quads a side of a ground that will be refined, by default.
constexpr int kRefinedGroundQuads = 16;

// Limits of addGround() and scene files.
constexpr int kMostGroundQuads = 4096;
constexpr float kSmallestGroundExtent = 0.01f, kLargestGroundExtent = 1000.0f;

// Returns a square centered under `object` in x and z, at its lowest y, normals up.
Mesh makeGround(const Bounds& object, const GroundOptions& options = {});

} // namespace relume

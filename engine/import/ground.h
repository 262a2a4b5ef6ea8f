// The diffuse ground under an object: a tessellated square at the object's lowest point.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

struct GroundOptions {
    int tessellation = 148; // Quads a side: 149² = 22,201 vertices, the paper's ground for the bunny.
    float extent = 3.0f;    // Side, in units of the object's largest horizontal or vertical extent.
    bool isStart = false;   // Whether refinement is to add vertices: nobody asked for this tessellation.
};

// Quads a side of a ground that is refined, unless it says its own.
constexpr int kRefinedGroundQuads = 16;

// What addGround() and scene files accept.
constexpr int kMostGroundQuads = 4096;
constexpr float kSmallestGroundExtent = 0.01f, kLargestGroundExtent = 1000.0f;

// A square centered under `object` in x and z, at its lowest y, normals up.
Mesh makeGround(const Bounds& object, const GroundOptions& options = {});

} // namespace relume

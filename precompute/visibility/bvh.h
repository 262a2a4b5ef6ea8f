// A bounding volume hierarchy over triangles with eight children per node, as traversed by
// shaders/visibility_trace.comp.
#pragma once

#include "engine/scene/mesh.h"
#include "shaders/shared/bake.h"

#include <vector>

namespace relume {

struct Bvh {
    // kBvhWidth children per node; the root is node 0. As far as possible, the child in slot s lies, from the
    // node's center, towards +X, +Y and +Z where bits 0, 1 and 2 of s are set: the order s ^ octant is
    // approximately front to back.
    std::vector<shared::BvhChild> children;
    std::vector<std::array<vec4, 3>> triangles; // corners, in the order of the leaves; w unused
    uint32_t depth = 0;                         // nodes on the longest path from the root to a leaf
};

// Builds the hierarchy, deterministically. An empty mesh gives a root without children. Throws Error for more
// triangles than a leaf's 26 bits can number.
Bvh buildBvh(const Mesh& mesh);

} // namespace relume

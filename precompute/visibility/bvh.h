// A bounding volume hierarchy over triangles, eight children a node, as shaders/visibility_trace.comp walks
// it.
#pragma once

#include "engine/scene/mesh.h"
#include "shaders/shared/bake.h"

#include <vector>

namespace relume {

struct Bvh {
    // kBvhWidth children a node, node after node; the root is node 0. A node's children are placed so that
    // slot s lies, seen from the node's middle, towards +X, +Y, +Z where bits 0, 1, 2 of s are set, as far as
    // that goes: slots in the order s ^ octant are about from near to far.
    std::vector<shared::BvhChild> children;
    std::vector<std::array<vec4, 3>> triangles; // corners, in the order of the leaves; w unused
    uint32_t depth = 0;                         // nodes on the longest way from the root to a leaf
};

// Deterministic. An empty mesh gives a root without children. Throws Error for more triangles than a leaf's
// 26 bits can number.
Bvh buildBvh(const Mesh& mesh);

} // namespace relume

// The coarse vertices that a vertex between them is interpolated from.
#pragma once

#include "engine/scene/mesh.h"

#include <array>
#include <span>

namespace relume {

// A coarse vertex by its place in their list, and its share.
struct CoarseNeighbor {
    uint32_t coarse;
    float weight;
};

// Finds the nearest in place, tangent frame and plane. Shares add up to one and change continuously over a
// smooth surface (Shepard's weights, which Franke and Little let vanish at the first neighbor left out);
// they are balanced, so that what changes linearly over the surface is met.
class CoarseNeighbors {
  public:
    // Of a mesh that outlives it, with `coarse` of coarseVertices() and the spacing it was given.
    CoarseNeighbors(const Mesh& mesh, std::span<const uint32_t> coarse, float spacing);

    // A coarse vertex has itself alone. None has a neighbor whose normal is not like its own
    // (kLeastNormalCosine).
    std::vector<CoarseNeighbor> of(uint32_t vertex) const;

  private:
    // Place, normal and tangent, in spacings.
    using Feature = std::array<float, 9>;
    struct Point {
        Feature feature;
        vec3 normal;
        uint32_t coarse;
    };
    // A box around points [first, end); unless a leaf, its halves are the nodes next to it and `right`.
    struct Node {
        Feature low, high;
        uint32_t first, end, right;
    };
    struct Search;

    Point pointOf(const Mesh& mesh, uint32_t vertex) const;
    void balance(uint32_t vertex, std::vector<CoarseNeighbor>& neighbors) const;
    void build(uint32_t first, uint32_t end);
    void search(uint32_t node, Search& search) const;

    const Mesh& mMesh;
    float mScale;
    std::vector<uint32_t> mCoarse;
    std::vector<Point> mPoints;
    std::vector<Node> mNodes;
};

} // namespace relume

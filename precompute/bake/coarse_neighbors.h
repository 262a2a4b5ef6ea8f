// Finds the coarse vertices from which another vertex is interpolated, and their weights.
#pragma once

#include "engine/scene/mesh.h"

#include <array>
#include <span>

namespace relume {

// An index into the list of coarse vertices, and its weight.
struct CoarseNeighbor {
    uint32_t coarse;
    float weight;
};

// Finds nearest neighbors in position, tangent frame and distance from the tangent plane. Weights are
// Shepard's, as modified by Franke and Little to vanish at the first neighbor left out: they add up to one
// and change continuously over a smooth surface. They are then balanced so that linear functions over the
// surface are reproduced.
class CoarseNeighbors {
  public:
    // Keeps a reference to `mesh`. `coarse` is from coarseVertices(), `spacing` what was passed to it.
    CoarseNeighbors(const Mesh& mesh, std::span<const uint32_t> coarse, float spacing);

    // Returns the neighbors of a vertex; a coarse vertex has only itself. The normals of neighbors differ by
    // less than kLeastNormalCosine allows.
    std::vector<CoarseNeighbor> of(uint32_t vertex) const;

  private:
    // Position, normal and tangent, in units of the spacing.
    using Feature = std::array<float, 9>;
    struct Point {
        Feature feature;
        vec3 normal;
        uint32_t coarse;
    };
    // A bounding box of points [first, end). Unless it is a leaf (right == 0), its children are the next node
    // and `right`.
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

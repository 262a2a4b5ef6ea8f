// Culling of those parts of a mesh that a camera cannot see, before drawing it.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// The view with which a mesh is drawn.
struct ClusterView {
    mat4 clipFromWorld; // last row gives depth: its first three elements have unit length
    vec3 eye;
    float focalLength;   // pixels that a unit of length covers at unit depth
    float pixelFraction; // positions are rounded to multiples of this fraction of a pixel
    bool hidesBacks;     // whether triangles that are clockwise in the image are not drawn
};

// Consecutive triangles.
struct TriangleRun {
    uint32_t first, count;
};

// Clusters of a few consecutive triangles, which in a bake are neighbors that face alike
// (docs/view_speed.md).
class TriangleClusters {
  public:
    TriangleClusters() = default;
    explicit TriangleClusters(const Mesh& mesh);

    // Returns rising runs that contain every triangle which may cover a pixel, however the device rounds.
    // Clusters are left out that are beyond one plane of the frustum, or show only backs if those are hidden.
    std::vector<TriangleRun> visible(const ClusterView& view) const;

  private:
    struct Cluster {
        vec3 center;
        float radius;   // slightly enlarged, for rounding
        float shortest; // the shortest of its triangles' longest edges, not counting those of no length
    };

    bool showsBacksAlone(size_t cluster, const ClusterView& view) const;

    std::vector<Cluster> mClusters;
    // Per triangle: the normal, scaled to the height over the longest edge, and its product with a corner.
    std::vector<vec4> mPlanes;
};

} // namespace relume

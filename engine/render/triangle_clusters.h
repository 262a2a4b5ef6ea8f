// What of a mesh a camera cannot see, found ahead of drawing it.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// What a mesh is drawn with.
struct ClusterView {
    mat4 clipFromWorld; // its last row of unit length but for its last element: depth
    vec3 eye;
    float focalLength;   // pixels that a unit of length takes at unit depth
    float pixelFraction; // of a pixel: places are rounded to multiples of it
    bool hidesBacks;     // triangles that are clockwise in the image are not drawn
};

struct TriangleRun {
    uint32_t first, count;
};

// Consecutive triangles by the few: those of a bake are neighbors that face alike (docs/view_speed.md).
class TriangleClusters {
  public:
    TriangleClusters() = default;
    explicit TriangleClusters(const Mesh& mesh);

    // Rising runs that hold every triangle which may cover a pixel, however the device rounds. Clusters are
    // left out that are beyond one plane of the frustum, or show nothing but backs where those are hidden.
    std::vector<TriangleRun> visible(const ClusterView& view) const;

  private:
    struct Cluster {
        vec3 center;
        float radius;   // a little more, for rounding
        float shortest; // of its triangles' longest edges, those of no length aside
    };

    bool showsBacksAlone(size_t cluster, const ClusterView& view) const;

    std::vector<Cluster> mClusters;
    // Of every triangle: the normal, as long as the height over the longest edge, and its product with a
    // corner.
    std::vector<vec4> mPlanes;
};

} // namespace relume

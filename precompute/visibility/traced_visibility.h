// Computes visibility cubes by tracing rays through a bounding volume hierarchy in a compute shader.
#pragma once

#include "precompute/visibility/visibility.h"

namespace relume {

// One subgroup traces all rays of a tile of a cube face together. Agrees with Embree except for rays that
// pass an edge within rounding. There is no near distance: points on a surface must be lifted.
class TracedVisibility : public Visibility {
  public:
    // As makeVisibility().
    TracedVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size);

    static Kernels kernels();

    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const override;

    // Throws if the device ended a long traversal early (lavapipe ends loops after 65,535 iterations), which
    // takes a tile with some hundred thousand visible triangles.
    void check() const override;

  private:
    uint32_t mTiles; // per cube
    vk::Buffer mNodes, mTriangles, mUnfinished;
    vk::ComputeProgram mTrace;
};

} // namespace relume

// Visibility cubes by rays through a bounding volume hierarchy, in a compute shader.
#pragma once

#include "precompute/visibility/visibility.h"

namespace relume {

// A subgroup of the device traces all rays of a tile of a cube's face together. Agrees with Embree but where
// a ray passes an edge within rounding. Nothing is too near to be seen: points on a surface are to be lifted.
class TracedVisibility : public Visibility {
  public:
    // As makeVisibility.
    TracedVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size);

    static Kernels kernels();

    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const override;

    // Some devices end loops that take long (lavapipe after 65,535 turns): a tile that sees some hundred
    // thousand triangles none of which hides another.
    void check() const override;

  private:
    uint32_t mTiles; // of a cube
    vk::Buffer mNodes, mTriangles, mUnfinished;
    vk::ComputeProgram mTrace;
};

} // namespace relume

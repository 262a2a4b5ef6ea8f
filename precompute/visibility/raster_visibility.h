// Visibility cubes by rasterising the occluder from every point, many points a submission.
#pragma once

#include "engine/vk/commands.h"
#include "precompute/visibility/occluder.h"
#include "shaders/shared/bake.h"

namespace relume {

// The near plane of points lifted by `offset`: a thousandth of it.
inline float visibilityNearDistance(float offset) { return 1e-3f * offset; }

// A mesh's vertex as the bake sees it, lifted by `offset` along its normal.
inline shared::BakePoint bakePoint(const Mesh& mesh, size_t vertex, float offset) {
    return {mesh.positions[vertex] + offset * mesh.normals[vertex], mesh.normals[vertex]};
}

// Fills a buffer with one bit per texel: 6 · size² bits a point, face after face, row by row, bit i of a
// word being texel i of its 32. A bit is set where the direction is free and above the point's horizon.
//
// Self-intersection: points are lifted off the surface (visibilityOffset) and triangles nearer than
// `nearDistance` along a face's axis are clipped. Nothing of a convex object rises above a lifted
// tangent plane, so it stays unshadowed; contact shadows stay attached to within the offset.
class RasterVisibility {
  public:
    // `size` a multiple of 32; at most `capacity` points a batch (6 layers each). Throws OutOfMemory when a
    // smaller batch may do, Error when the occluder has more triangles than the device can bind.
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance);

    // Records the visibility of the first `count` BakePoints into the front of `bits`.
    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const;

    // Bytes of one point's bits.
    static uint64_t bytesPerPoint(uint32_t size) { return 6ull * size * size / 8; }

  private:
    void createGeometry(const vk::Device& device, const Mesh& occluder);

    uint32_t mSize, mCapacity;
    float mNearDistance;
    uint32_t mClusterCount = 0;
    vk::Buffer mPositions, mIndices, mClusters, mDraws, mLayers, mBlocked;
    vk::Image mTarget;
    vk::ComputeProgram mReset, mCull, mPack;
    vk::GraphicsProgram mDraw;
};

} // namespace relume

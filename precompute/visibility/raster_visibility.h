// Visibility cubes by rasterising the occluder from every point, many points a submission.
#pragma once

#include "precompute/visibility/visibility.h"

namespace relume {

// Clusters of triangles are culled per point and cube face on the device, and drawn with indirect draws into
// six layers a point.
class RasterVisibility : public Visibility {
  public:
    // Whether clusters that cannot show in a face are left out; the bits are the same.
    enum class Culling { On, Off };

    // As makeVisibility; six layers a point must fit an image.
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance, Culling culling = Culling::On);

    static Kernels kernels();

    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const override;

    // Triangles that the last finished submission drew, over all faces of its points. Reads back: for
    // measurements.
    uint64_t drawnTriangles(const vk::Device& device) const;

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

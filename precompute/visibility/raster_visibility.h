// Computes visibility cubes by rasterizing the occluder from every point, many points per submission.
#pragma once

#include "precompute/visibility/visibility.h"

namespace relume {

// Clusters of triangles are culled per point and cube face on the device and drawn by indirect draws into six
// layers per point: all together if vertex shaders can choose the layer, otherwise one by one.
class RasterVisibility : public Visibility {
  public:
    // On skips clusters that cannot be visible in a face, and front faces of closed surfaces. The bits are
    // the same, except that a device that culls before it rounds corners may lose one texel in a million at
    // silhouettes.
    enum class Culling { On, Off };
    // How layers are drawn; the bits are the same. Together requires DeviceInfo::outputsLayers.
    enum class Layers { Together, OneByOne };

    // As makeVisibility(). With Layers::Together, six layers per point must fit an image.
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance, Culling culling, Layers layers);
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance);

    static Kernels kernels();

    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const override;

    // Returns the number of triangles that the last finished submission, of `count` points, drew over all
    // faces. Reads back from the device; for measurements.
    uint64_t drawnTriangles(const vk::Device& device, uint32_t count) const;

  private:
    void createGeometry(const vk::Device& device, const Mesh& occluder, Culling culling);
    void drawClusters(vk::Commands& commands, std::initializer_list<vk::Binding> bindings,
                      const shared::VisibilityPush& push, uint64_t firstDraw) const;
    void recordTogether(vk::Commands& commands, const vk::Buffer& points, uint32_t layers) const;
    void recordOneByOne(vk::Commands& commands, const vk::Buffer& points, uint32_t layers) const;
    // Returns the number of indirect draws for this many points.
    uint64_t drawCount(uint32_t points) const { return mClusterCount * (mIsLayered ? 1 : 6ull * points); }

    uint32_t mSize, mCapacity;
    bool mIsLayered;
    float mHorizonMargin, mDepthScale; // as in VisibilityPush
    uint32_t mClusterCount = 0;
    uint32_t mClosedCount = 0; // the first clusters are those of closed surfaces
    vk::Buffer mPositions, mIndices, mClusters, mDraws, mLayers, mBlocked;
    vk::Image mTarget; // all layers, or one
    vk::ComputeProgram mReset, mCull, mPack;
    vk::GraphicsProgram mDraw, mDrawBackFaces;
};

} // namespace relume

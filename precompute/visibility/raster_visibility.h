// Visibility cubes by rasterizing the occluder from every point, many points a submission.
#pragma once

#include "precompute/visibility/visibility.h"

namespace relume {

// Clusters of triangles are culled per point and cube face on the device, and drawn with indirect draws into
// six layers a point: all at once where vertex shaders can choose the layer, else one by one.
class RasterVisibility : public Visibility {
  public:
    // On leaves out clusters that cannot show in a face, and front faces of closed surfaces. The bits are the
    // same, except that a device which culls before it rounds corners may lose a texel in a million at
    // silhouettes.
    enum class Culling { On, Off };
    // How layers are drawn; the bits are the same. Together is for devices with DeviceInfo::outputsLayers.
    enum class Layers { Together, OneByOne };

    // As makeVisibility; drawn together, six layers a point must fit an image.
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance, Culling culling, Layers layers);
    RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size, uint32_t capacity,
                     float nearDistance);

    static Kernels kernels();

    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const override;

    // Triangles that the last finished submission, of `count` points, drew over all their faces. Reads back:
    // for measurements.
    uint64_t drawnTriangles(const vk::Device& device, uint32_t count) const;

  private:
    void createGeometry(const vk::Device& device, const Mesh& occluder, Culling culling);
    void drawClusters(vk::Commands& commands, std::initializer_list<vk::Binding> bindings,
                      const shared::VisibilityPush& push, uint64_t firstDraw) const;
    void recordTogether(vk::Commands& commands, const vk::Buffer& points, uint32_t layers) const;
    void recordOneByOne(vk::Commands& commands, const vk::Buffer& points, uint32_t layers) const;
    // Indirect draws of so many points.
    uint64_t drawCount(uint32_t points) const { return mClusterCount * (mIsLayered ? 1 : 6ull * points); }

    uint32_t mSize, mCapacity;
    bool mIsLayered;
    float mHorizonMargin, mDepthScale; // as in VisibilityPush
    uint32_t mClusterCount = 0;
    uint32_t mClosedCount = 0; // the first clusters are of closed surfaces
    vk::Buffer mPositions, mIndices, mClusters, mDraws, mLayers, mBlocked;
    vk::Image mTarget; // of all layers, or of one
    vk::ComputeProgram mReset, mCull, mPack;
    vk::GraphicsProgram mDraw, mDrawBackFaces;
};

} // namespace relume

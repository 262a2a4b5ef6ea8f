// Composition of a view over the light that is seen behind it.
#pragma once

#include "engine/light/background.h"
#include "engine/vk/commands.h"

namespace relume {

// Composites views over backgrounds. Keeps a reference to the device, which must outlive it.
class BackgroundPass {
  public:
    explicit BackgroundPass(const vk::Device& device);

    // Sets the background of the record() calls that follow, by makeBackground(). Uploads its map, and waits
    // for that, unless the light before had the same map.
    void setLight(const Light& light, float deviation = 0);

    // Records pass "background": composites `view`, whose radiance is premultiplied by alpha, over the
    // background turned by `turn` radians. `view` is in TRANSFER_SRC_OPTIMAL before and after, image() after.
    void record(vk::Commands& commands, const vk::Image& view, const Camera& camera, float turn = 0);

    // Returns the result: RGBA32F, linear, alpha 1.
    const vk::Image& image() const { return mImage; }

    // Returns the image of the last submission. Waits for the device.
    Image read() const;

  private:
    const vk::Device& mDevice;
    vk::GraphicsProgram mProgram;
    vk::Sampler mPixelSampler, mMapSampler;
    Background mBackground;
    std::shared_ptr<const Environment> mUploaded; // what mMap holds
    vk::Image mMap, mImage;
    vk::Buffer mLight; // shared::LightSky, kMostSources + 1 × shared::BackgroundDisc
};

} // namespace relume

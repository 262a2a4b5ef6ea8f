// A view over the light that is seen behind it.
#pragma once

#include "engine/light/background.h"
#include "engine/vk/commands.h"

namespace relume {

class BackgroundPass {
  public:
    explicit BackgroundPass(const vk::Device& device);

    // The background of the record() calls that follow: makeBackground(). Uploads its map, unless the last
    // light had it, and waits for that.
    void setLight(const Light& light, float deviation = 0);

    // Pass "background": `view`, whose radiance is premultiplied by alpha, over the background turned by
    // `turn` radians. It is in TRANSFER_SRC_OPTIMAL before and after, and so is image() then.
    void record(vk::Commands& commands, const vk::Image& view, const Camera& camera, float turn = 0);

    // RGBA32F, linear, alpha 1.
    const vk::Image& image() const { return mImage; }

    // The image of the last submission. Waits for the device.
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

// Visual comparison of two views in one image: side by side, or as a map of their difference.
#pragma once

#include "engine/vk/commands.h"

namespace relume {

enum class CompareMode { Split, Difference };

struct CompareOptions {
    CompareMode mode = CompareMode::Split;
    float split = 0.5f; // share of the width, from the left, that shows the first image
    float scale = 1;    // factor on the mean of a pixel's three differences before heatColor() (compare.h)
};

// Compares two images. Keeps a reference to the device, which must outlive it.
class ComparePass {
  public:
    explicit ComparePass(const vk::Device& device);

    // Records pass "compare" of two linear images of one size, in TRANSFER_SRC_OPTIMAL before and after, as
    // image() is after.
    void record(vk::Commands& commands, const vk::Image& first, const vk::Image& second,
                const CompareOptions& options);

    // Returns the result: RGBA32F; alpha is that of the images.
    const vk::Image& image() const { return mImage; }

  private:
    const vk::Device& mDevice;
    vk::GraphicsProgram mProgram;
    vk::Sampler mSampler;
    vk::Image mImage;
};

} // namespace relume

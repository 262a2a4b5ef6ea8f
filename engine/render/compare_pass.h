// Two views in one image, for eyes: side by side, or how far apart they are.
#pragma once

#include "engine/vk/commands.h"

namespace relume {

enum class CompareMode { Split, Difference };

struct CompareOptions {
    CompareMode mode = CompareMode::Split;
    float split = 0.5f; // of the width: what is left of it shows the first image, the rest the second
    float scale = 1;    // of the mean of a pixel's three differences, for heatColor() (heat_color.h)
};

class ComparePass {
  public:
    explicit ComparePass(const vk::Device& device);

    // Pass "compare": both linear images of one size, in TRANSFER_SRC_OPTIMAL before and after; image() is
    // too, then.
    void record(vk::Commands& commands, const vk::Image& first, const vk::Image& second,
                const CompareOptions& options);

    // RGBA32F; alpha as the images have it.
    const vk::Image& image() const { return mImage; }

  private:
    const vk::Device& mDevice;
    vk::GraphicsProgram mProgram;
    vk::Sampler mSampler;
    vk::Image mImage;
};

} // namespace relume

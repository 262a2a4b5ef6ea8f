// Conversion of a view to display values, onto a window's image.
#pragma once

#include "engine/render/tone_map.h"
#include "engine/vk/commands.h"

#include <array>

namespace relume {

struct DisplayOptions {
    ToneCurve curve = ToneCurve::Agx;
    float exposureStops = 0;
    vec3 background{0}; // display values where nothing is covered
};

// Tone-maps views onto images of a window.
class DisplayPass {
  public:
    // `format` is that of the images drawn on, without conversion to sRGB.
    DisplayPass(const vk::Device& device, VkFormat format);

    // Records pass "display": toneMap() of `view` onto `target`, of the same size. `view` is in
    // TRANSFER_SRC_OPTIMAL before and after; `target` is overwritten, and left in COLOR_ATTACHMENT_OPTIMAL.
    void record(vk::Commands& commands, const vk::Image& view, const vk::Image& target,
                const DisplayOptions& options) const;

  private:
    std::array<vk::GraphicsProgram, 3> mPrograms; // by curve
    vk::Sampler mSampler;
};

} // namespace relume

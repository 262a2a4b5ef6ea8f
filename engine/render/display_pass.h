// A window's image: the view as a display takes it.
#pragma once

#include "engine/render/tone_map.h"
#include "engine/vk/commands.h"

#include <array>

namespace relume {

struct DisplayOptions {
    ToneCurve curve = ToneCurve::Agx;
    float exposureStops = 0;
    vec3 background{0}; // display values, where nothing is covered
};

class DisplayPass {
  public:
    // `format`: of the images drawn on, not converting.
    DisplayPass(const vk::Device& device, VkFormat format);

    // Pass "display": toneMap() of `view`, which is in TRANSFER_SRC_OPTIMAL before and after, onto `target`
    // of the same size, whose contents are lost; then in COLOR_ATTACHMENT_OPTIMAL.
    void record(vk::Commands& commands, const vk::Image& view, const vk::Image& target,
                const DisplayOptions& options) const;

  private:
    std::array<vk::GraphicsProgram, 3> mPrograms; // by curve
    vk::Sampler mSampler;
};

} // namespace relume

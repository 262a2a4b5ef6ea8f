#include "engine/render/display_pass.h"

#include "shaders/display_frag.h"
#include "shaders/display_vert.h"
#include "shaders/shared/render.h"

#include <cmath>

namespace relume {

using vk::Stage;

DisplayPass::DisplayPass(const vk::Device& device, VkFormat format)
    : mProgram(device, display_vert_spirv, display_frag_spirv, {}, {.colorFormat = format}, "display"),
      mSampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
               "display", VK_FILTER_NEAREST) {}

void DisplayPass::record(vk::Commands& commands, const vk::Image& view, const vk::Image& target,
                         const DisplayOptions& options) const {
    RELUME_CHECK_EQ(view.options().width, target.options().width);
    RELUME_CHECK_EQ(view.options().height, target.options().height);
    static_assert(uint32_t(ToneCurve::Aces) == shared::kToneAces &&
                  uint32_t(ToneCurve::Agx) == shared::kToneAgx);
    const shared::DisplayPush push{options.background, std::exp2(options.exposureStops),
                                   uint32_t(options.curve)};
    commands.pass("display", [&] {
        commands.transition(view, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Transfer, Stage::Draw);
        commands.transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Color, Stage::Color);
        commands.render({.color = &target}, [&] {
            commands.bind(mProgram, {{view, mSampler}}, push);
            commands.draw(3);
        });
        commands.transition(view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Stage::Draw, Stage::Transfer);
    });
}

} // namespace relume

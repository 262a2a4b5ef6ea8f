#include "engine/render/display_pass.h"

#include "shaders/display_frag.h"
#include "shaders/display_vert.h"
#include "shaders/shared/render.h"

#include <cmath>

namespace relume {

using vk::Stage;

DisplayPass::DisplayPass(const vk::Device& device, VkFormat format)
    : mSampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
               "display", VK_FILTER_NEAREST) {
    static_assert(uint32_t(ToneCurve::None) == shared::kToneNone &&
                  uint32_t(ToneCurve::Aces) == shared::kToneAces &&
                  uint32_t(ToneCurve::Agx) == shared::kToneAgx);
    for (uint32_t curve = 0; curve < mPrograms.size(); curve++)
        mPrograms[curve] = {device,  display_vert_spirv,      display_frag_spirv,
                            {curve}, {.colorFormat = format}, "display"};
}

void DisplayPass::record(vk::Commands& commands, const vk::Image& view, const vk::Image& target,
                         const DisplayOptions& options) const {
    RELUME_CHECK_EQ(view.options().width, target.options().width);
    RELUME_CHECK_EQ(view.options().height, target.options().height);
    const shared::DisplayPush push{options.background, std::exp2(options.exposureStops)};
    commands.pass("display", [&] {
        commands.transition(view, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Stage::Transfer, Stage::Draw);
        commands.transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Stage::Color, Stage::Color);
        commands.render({.color = &target}, [&] {
            commands.bind(mPrograms[size_t(options.curve)], {{view, mSampler}}, push);
            commands.draw(3);
        });
        commands.transition(view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Stage::Draw, Stage::Transfer);
    });
}

} // namespace relume

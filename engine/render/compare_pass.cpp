#include "engine/render/compare_pass.h"

#include "engine/base/check.h"
#include "shaders/compare_frag.h"
#include "shaders/display_vert.h"
#include "shaders/shared/render.h"

namespace relume {

using vk::Stage;

ComparePass::ComparePass(const vk::Device& device)
    : mDevice(device), mProgram(device, display_vert_spirv, compare_frag_spirv, {}, {}, "compare"),
      mSampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
               "compare", VK_FILTER_NEAREST) {}

void ComparePass::record(vk::Commands& commands, const vk::Image& first, const vk::Image& second,
                         const CompareOptions& options) {
    static_assert(uint32_t(CompareMode::Split) == shared::kCompareSplit &&
                  uint32_t(CompareMode::Difference) == shared::kCompareDifference);
    const uint32_t width = first.options().width, height = first.options().height;
    RELUME_CHECK_EQ(second.options().width, width);
    RELUME_CHECK_EQ(second.options().height, height);
    if (mImage.options().width != width || mImage.options().height != height || !mImage.handle())
        mImage = vk::Image(mDevice,
                           {.width = width,
                            .height = height,
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT},
                           "compared");
    const shared::ComparePush push{uint32_t(options.mode), options.split * float(width), options.scale};
    constexpr VkImageLayout kSource = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            kWrite = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    commands.pass("compare", [&] {
        for (const vk::Image* image : {&first, &second})
            commands.transition(*image, kSource, kRead, Stage::Transfer, Stage::Draw);
        commands.transition(mImage, VK_IMAGE_LAYOUT_UNDEFINED, kWrite, Stage::Draw, Stage::Color);
        commands.render({.color = &mImage}, [&] {
            commands.bind(mProgram, {{first, mSampler}, {second, mSampler}}, push);
            commands.draw(3);
        });
        for (const vk::Image* image : {&first, &second})
            commands.transition(*image, kRead, kSource, Stage::Draw, Stage::Transfer);
        commands.transition(mImage, kWrite, kSource, Stage::Color, Stage::Transfer);
    });
}

} // namespace relume

// What a display pass, made for it, shows of an image.
#pragma once

#include "engine/image/image.h"
#include "engine/render/display_pass.h"
#include "engine/vk/upload.h"

namespace relume::test {

inline Image displayed(const vk::Device& device, const Image& image, const DisplayOptions& options) {
    const uint32_t width = uint32_t(image.width), height = uint32_t(image.height);
    const vk::Image view =
        vk::uploadImage(device,
                        {.width = width,
                         .height = height,
                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                        std::as_bytes(std::span(image.pixels)), "view");
    constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
    const vk::Image target(device,
                           {.format = kFormat,
                            .width = width,
                            .height = height,
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                           "target");
    const DisplayPass pass(device, kFormat);
    const vk::Buffer readback(device, 4 * width * height, vk::BufferUse::Readback, "readback");
    vk::Commands commands(device, "display");
    commands.begin();
    commands.transition(view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        vk::Stage::Transfer, vk::Stage::Transfer);
    for (int i = 0; i < 2; i++) pass.record(commands, view, target, options); // the view is as it was
    commands.transition(target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Color, vk::Stage::Transfer);
    commands.copy(target, readback, 1);
    commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    commands.submitAndWait();
    Image shown(image.width, image.height);
    for (size_t i = 0; i < shown.pixels.size(); i++)
        for (int c = 0; c < 4; c++)
            shown.pixels[i][c] = float(readback.map<uint8_t>()[4 * i + size_t(c)]) / 255;
    return shown;
}

} // namespace relume::test

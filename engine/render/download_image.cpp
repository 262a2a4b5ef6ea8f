#include "engine/render/download_image.h"

#include "engine/vk/commands.h"

#include <algorithm>
#include <span>

namespace relume {

Image downloadImage(const vk::Device& device, const vk::Image& source) {
    Image image(int(source.options().width), int(source.options().height));
    const vk::Buffer readback(device, std::span(image.pixels).size_bytes(), vk::BufferUse::Readback,
                              "image download");
    vk::Commands commands(device, "image download");
    commands.begin();
    commands.copy(source, readback, 1);
    commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    commands.submitAndWait();
    std::ranges::copy(readback.map<vec4>(), image.pixels.begin());
    return image;
}

} // namespace relume

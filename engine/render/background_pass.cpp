#include "engine/render/background_pass.h"

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/render/view_image.h"
#include "engine/vk/upload.h"
#include "shaders/background_frag.h"
#include "shaders/display_vert.h"

#include <cstring>
#include <glm/gtc/packing.hpp>

namespace relume {

using vk::Stage;

namespace {

constexpr float kLargestHalf = 65504;

vk::Image uploadMap(const vk::Device& device, const Environment& map) {
    std::vector<uint64_t> texels(map.radiance.size());
    parallelFor(size_t(map.height), [&](size_t y) {
        for (size_t i = y * size_t(map.width); i < (y + 1) * size_t(map.width); i++)
            texels[i] = glm::packHalf4x16(vec4(glm::min(map.radiance[i], vec3(kLargestHalf)), 1));
    });
    return vk::uploadImage(device,
                           {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                            .width = uint32_t(map.width),
                            .height = uint32_t(map.height)},
                           std::as_bytes(std::span(texels)), "background map");
}

} // namespace

BackgroundPass::BackgroundPass(const vk::Device& device)
    : mDevice(device), mProgram(device, display_vert_spirv, background_frag_spirv, {}, {}, "background"),
      mPixelSampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                    "background view", VK_FILTER_NEAREST),
      mMapSampler(device, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                  "background map"),
      mLight(device, sizeof(shared::LightSky) + (kMostSources + 1) * sizeof(shared::BackgroundDisc),
             vk::BufferUse::Device, "background light") {
    setLight({});
}

void BackgroundPass::setLight(const Light& light, float deviation) {
    RELUME_CHECK_LE(light.strokes.size(), kMostSources);
    mBackground = makeBackground(light, deviation, mBackground);
    if (mMap.handle() && mBackground.map == mUploaded) return;
    const int most = int(mDevice.limits().maxImageDimension2D);
    if (const auto& map = mBackground.map; !map)
        mMap = uploadMap(mDevice, {1, 1, {vec3(0)}});
    else
        mMap = uploadMap(mDevice, map->width <= most ? *map : prepareForSampling(*map, most));
    mUploaded = mBackground.map; // not before: the next call tries again if this one fails
}

void BackgroundPass::record(vk::Commands& commands, const vk::Image& view, const Camera& camera, float turn) {
    const uint32_t width = view.options().width, height = view.options().height;
    if (!mImage.handle() || mImage.options().width != width || mImage.options().height != height)
        mImage = vk::Image(mDevice,
                           {.width = width,
                            .height = height,
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT},
                           "view over background");
    std::vector<shared::BackgroundDisc> discs = mBackground.strokes;
    discs.push_back(mBackground.sun);
    const shared::LightSky sky = mBackground.sky.value_or(shared::LightSky{});
    std::vector<std::byte> bytes(sizeof sky + std::span(discs).size_bytes());
    std::memcpy(bytes.data(), &sky, sizeof sky);
    std::memcpy(bytes.data() + sizeof sky, discs.data(), std::span(discs).size_bytes());
    commands.barrier(Stage::Draw, Stage::Transfer); // an earlier frame may still be reading it
    commands.update(mLight, bytes);
    commands.barrier(Stage::Transfer, Stage::Draw);
    constexpr VkImageLayout kSource = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            kWrite = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    commands.pass("background", [&] {
        commands.transition(view, kSource, kRead, Stage::Transfer, Stage::Draw);
        commands.transition(mImage, VK_IMAGE_LAYOUT_UNDEFINED, kWrite, Stage::Transfer, Stage::Color);
        commands.render({.color = &mImage}, [&] {
            commands.bind(mProgram, {{view, mPixelSampler}, {mMap, mMapSampler}, mLight},
                          makeBackgroundPush(mBackground, camera, turn, int(width), int(height)));
            commands.draw(3);
        });
        commands.transition(view, kRead, kSource, Stage::Draw, Stage::Transfer);
        commands.transition(mImage, kWrite, kSource, Stage::Color, Stage::Transfer);
    });
}

Image BackgroundPass::read() const { return downloadImage(mDevice, mImage); }

} // namespace relume

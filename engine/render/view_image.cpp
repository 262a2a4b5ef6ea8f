#include "engine/render/view_image.h"

#include "engine/render/pixel_samples.h"
#include "engine/vk/commands.h"

#include <algorithm>
#include <span>

namespace relume {

namespace {

VkFormatFeatureFlags featuresOf(const vk::Device& device, VkFormat format) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
    return properties.optimalTilingFeatures;
}

// Returns the sample counts that the device supports for optimal images of a format and usage.
VkSampleCountFlags sampleCounts(const vk::Device& device, VkFormat format, VkImageUsageFlags usage) {
    VkImageFormatProperties properties{};
    if (vkGetPhysicalDeviceImageFormatProperties(device.physical(), format, VK_IMAGE_TYPE_2D,
                                                 VK_IMAGE_TILING_OPTIMAL, usage, 0,
                                                 &properties) != VK_SUCCESS)
        return VK_SAMPLE_COUNT_1_BIT;
    return properties.sampleCounts;
}

} // namespace

VkFormat viewDepthFormat(const vk::Device& device) {
    constexpr VkFormat kSmall = VK_FORMAT_D24_UNORM_S8_UINT, kLarge = VK_FORMAT_D32_SFLOAT_S8_UINT;
    const bool hasSmall = featuresOf(device, kSmall) & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    return hasSmall ? kSmall : kLarge;
}

// Queries each format, since limits may promise less: lavapipe's framebufferIntegerColorSampleCounts is 1,
// yet it draws these with 4.
int supportedViewSamples(const vk::Device& device, VkFormat depthFormat, int wanted) {
    expectSamples(wanted);
    const bool addsColors =
        featuresOf(device, kViewColorFormat) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    if (!device.limits().standardSampleLocations || !addsColors) return 1;
    const VkSampleCountFlags counts =
        sampleCounts(device, kTriangleIdFormat,
                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT) &
        sampleCounts(device, depthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    for (int samples = wanted; samples > 1; samples /= 2)
        if (counts & VkSampleCountFlags(samples)) return samples;
    return 1;
}

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

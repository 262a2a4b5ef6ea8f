// The formats of the images that views are drawn into, and how many samples a device has of them.
#pragma once

#include "engine/vk/device.h"

namespace relume {

constexpr VkFormat kViewColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kViewSurfaceFormat = VK_FORMAT_R32_UINT; // triangles' numbers

// Returns a format of depth and stencil: 24 bits of depth where the device has them, since they take half the
// memory of 32 and are as precise beyond twice the near plane's distance. Every device has one of the two.
VkFormat viewDepthFormat(const vk::Device& device);

// Returns the largest count of samples a pixel, at most `wanted` (expectSamples()), that the device draws
// views with: 1 where its samples are not at Vulkan's standard locations, or it cannot add up colors.
int supportedViewSamples(const vk::Device& device, VkFormat depthFormat, int wanted);

} // namespace relume

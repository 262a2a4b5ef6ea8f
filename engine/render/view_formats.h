// The formats of the images that views are drawn into, and the sample counts that a device supports for them.
#pragma once

#include "engine/vk/device.h"

namespace relume {

constexpr VkFormat kViewColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kTriangleIdFormat = VK_FORMAT_R32_UINT; // triangle ids

// Returns a format with depth and stencil. Prefers D24_S8: half the memory of D32_S8, and as precise beyond
// twice the near distance. Every device has one of the two.
VkFormat viewDepthFormat(const vk::Device& device);

// Returns the most samples per pixel, at most `wanted` (expectSamples()), with which the device can draw
// views. 1 if its samples are not at Vulkan's standard locations, or it cannot blend colors.
int supportedViewSamples(const vk::Device& device, VkFormat depthFormat, int wanted);

} // namespace relume

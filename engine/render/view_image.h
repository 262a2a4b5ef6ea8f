// The images that views are drawn into: their formats, the sample counts that a device supports for them, and
// their download to host memory.
#pragma once

#include "engine/image/image.h"
#include "engine/vk/device.h"
#include "engine/vk/image.h"

namespace relume {

constexpr VkFormat kViewColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kTriangleIdFormat = VK_FORMAT_R32_UINT; // triangle ids

// Returns a format with depth and stencil. Prefers D24_S8: half the memory of D32_S8, and as precise beyond
// twice the near distance. Every device has one of the two.
VkFormat viewDepthFormat(const vk::Device& device);

// Returns the most samples per pixel, at most `wanted` (expectSamples()), with which the device can draw
// views. 1 if its samples are not at Vulkan's standard locations, or it cannot blend colors.
int supportedViewSamples(const vk::Device& device, VkFormat depthFormat, int wanted);

// Returns the pixels of an RGBA32F image that is in TRANSFER_SRC_OPTIMAL. Waits for the device.
Image downloadImage(const vk::Device& device, const vk::Image& source);

} // namespace relume

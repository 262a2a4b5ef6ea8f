// Download of drawn images to host memory.
#pragma once

#include "engine/image/image.h"
#include "engine/vk/image.h"

namespace relume {

// Returns the pixels of an RGBA32F image that is in TRANSFER_SRC_OPTIMAL. Waits for the device.
Image downloadImage(const vk::Device& device, const vk::Image& source);

} // namespace relume

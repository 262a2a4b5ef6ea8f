// Helpers shared by device selection and `relume devices`: internal to engine/vk.
#pragma once

#include "engine/vk/device.h"

#include <optional>

namespace relume::vk {

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance);
DeviceInfo describeDevice(VkPhysicalDevice physical, uint32_t index);

// Returns whether the device has this queue family and it does both graphics and compute.
bool doesGraphicsAndCompute(VkPhysicalDevice physical, uint32_t family);

// Returns the first queue family that does both graphics and compute.
std::optional<uint32_t> findQueueFamily(VkPhysicalDevice physical);

} // namespace relume::vk

// Features that a device was made with: internal to engine/vk.
#pragma once

#include <string>
#include <string_view>
#include <vulkan/vulkan.h>

namespace relume::vk {

// What is needed and was not turned on, in words; empty where nothing is missing.
std::string missingFeature(const VkDeviceCreateInfo& created);

// Whether a feature that this file's tables name was turned on.
bool hasFeature(const VkDeviceCreateInfo& created, std::string_view name);

} // namespace relume::vk

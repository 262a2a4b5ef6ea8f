// Features that a device was made with: internal to engine/vk.
#pragma once

#include <string>
#include <string_view>
#include <vulkan/vulkan.h>

namespace relume::vk {

// Names the first needed feature that was not turned on, in a clause; empty where nothing is missing.
std::string missingFeature(const VkDeviceCreateInfo& created);

// Returns whether a feature was turned on. `name` is one of the table in features.cpp.
bool hasFeature(const VkDeviceCreateInfo& created, std::string_view name);

} // namespace relume::vk

// Queries about the features that a device was made with: internal to engine/vk.
#pragma once

#include <string>
#include <string_view>
#include <vulkan/vulkan.h>

namespace relume::vk {

// Returns a clause that names the first required feature that was not turned on; empty if none is missing.
std::string missingFeature(const VkDeviceCreateInfo& created);

// Returns whether a feature was turned on. `name` is from the table in features.cpp.
bool hasFeature(const VkDeviceCreateInfo& created, std::string_view name);

} // namespace relume::vk

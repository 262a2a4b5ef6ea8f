// Vulkan's result codes as errors.
#pragma once

#include "engine/base/error.h"

#include <vulkan/vulkan.h>

namespace relume::vk {

// Thrown when the device or the host runs out of memory. A smaller batch may do.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

// Throws OutOfMemory or Error, which names the call, unless `result` is VK_SUCCESS.
void check(VkResult result, const char* call);

} // namespace relume::vk

#define RELUME_VK(call) ::relume::vk::check(call, #call)

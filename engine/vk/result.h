// Vulkan's return codes as errors.
#pragma once

#include "engine/base/error.h"

#include <vulkan/vulkan.h>

namespace relume::vk {

// Not enough memory on the device or the host: a smaller batch may do.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

// Throws OutOfMemory or Error, naming the call, unless `result` is VK_SUCCESS.
void check(VkResult result, const char* call);

} // namespace relume::vk

#define RELUME_VK(call) ::relume::vk::check(call, #call)

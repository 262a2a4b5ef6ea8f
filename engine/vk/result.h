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

// Throws OutOfMemory, which names the call, if `result` says so.
void checkMemory(VkResult result, const char* call);

// Returns the object that `function`, a vkCreate… or vkAllocateMemory, makes of `info`. Throws like check().
// The handle that a failed call leaves is undefined, so nobody must get it to destroy.
template <typename Object, typename Owner, typename Info>
Object create(VkResult (*function)(Owner, const Info*, const VkAllocationCallbacks*, Object*),
              const char* call, Owner owner, const Info& info) {
    Object object;
    check(function(owner, &info, nullptr, &object), call);
    return object;
}

} // namespace relume::vk

#define RELUME_VK(call) ::relume::vk::check(call, #call)
#define RELUME_VK_CREATE(function, owner, info) ::relume::vk::create(function, #function, owner, info)

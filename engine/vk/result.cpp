#include "engine/vk/result.h"

#include <fmt/core.h>
#include <string_view>
#include <vulkan/vulkan.hpp>

namespace relume::vk {

static std::string_view nameOf(std::string_view call) { return call.substr(0, call.find('(')); }

void checkMemory(VkResult result, const char* call) {
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        throw OutOfMemory(fmt::format("{}: the device has too little free memory for this; close other "
                                      "programs, or ask for less",
                                      nameOf(call)));
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw OutOfMemory(fmt::format("{}: the driver has too little main memory for this; close other "
                                      "programs, or ask for less",
                                      nameOf(call)));
}

void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    checkMemory(result, call);
    if (result == VK_ERROR_DEVICE_LOST)
        throw Error(fmt::format(
            "{}: the Vulkan device was lost (a driver crash or reset); start again, or pick another device "
            "with --device",
            nameOf(call)));
    throw Error(fmt::format("{}: the Vulkan driver answered {}; update it, or pick another device with "
                            "--device",
                            nameOf(call), ::vk::to_string(::vk::Result(result))));
}

} // namespace relume::vk

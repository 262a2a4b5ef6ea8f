#include "engine/vk/result.h"

#include <fmt/format.h>
#include <string_view>
#include <vulkan/vulkan.hpp>

namespace relume::vk {

void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    const std::string_view text(call);
    const std::string_view name = text.substr(0, text.find('('));
    const std::string resultName = ::vk::to_string(::vk::Result(result));
    switch (result) {
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        throw OutOfMemory(
            fmt::format("{}: {}: the device has too little free memory for this", name, resultName));
    case VK_ERROR_DEVICE_LOST:
        throw Error(fmt::format(
            "{}: the Vulkan device was lost (a driver crash or reset); start again, or pick another device "
            "with --device",
            name));
    default:
        throw Error(fmt::format("{}: the Vulkan driver answered {}", name, resultName));
    }
}

} // namespace relume::vk

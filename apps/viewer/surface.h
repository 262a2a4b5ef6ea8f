// The Vulkan surface of a window.
#pragma once

#include <vulkan/vulkan.h>

namespace relume {

struct Surface {
    Surface(VkInstance owner, VkSurfaceKHR surface) : instance(owner), handle(surface) {}
    ~Surface() { vkDestroySurfaceKHR(instance, handle, nullptr); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    VkInstance instance;
    VkSurfaceKHR handle;
};

} // namespace relume

#include "engine/vk/swapchain.h"

#include "engine/vk/result.h"

#include <algorithm>
#include <fmt/core.h>
#include <utility>

namespace relume::vk {

namespace {

VkSurfaceFormatKHR formatOf(VkPhysicalDevice physical, VkSurfaceKHR surface) {
    uint32_t count = 0;
    RELUME_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr));
    std::vector<VkSurfaceFormatKHR> formats(count);
    RELUME_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()));
    for (const VkSurfaceFormatKHR& format : formats)
        if (format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM)
            return format;
    throw NoDeviceError("the window takes no images of 8 bits a channel without conversion");
}

} // namespace

Swapchain::Swapchain(const Device& device, VkSurfaceKHR surface, bool waitsForDisplay)
    : mDevice(device), mSurface(surface), mWaitsForDisplay(waitsForDisplay) {
    VkBool32 canShow = VK_FALSE;
    RELUME_VK(
        vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queueFamily(), surface, &canShow));
    if (!canShow)
        throw NoDeviceError(
            fmt::format("{}: cannot show images in this window; name another", device.name()));
    mFormat = formatOf(device.physical(), surface);
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    mAcquired = RELUME_VK_CREATE(vkCreateFence, device.handle(), fence);
}

Swapchain::~Swapchain() {
    destroy();
    vkDestroyFence(mDevice.handle(), mAcquired, nullptr);
}

void Swapchain::destroy() {
    if (!mSwapchain) return;
    {
        const auto lock = mDevice.lockQueue();
        vkQueueWaitIdle(mDevice.queue()); // for the last present
    }
    mImages.clear();
    vkDestroySwapchainKHR(mDevice.handle(), mSwapchain, nullptr);
    mSwapchain = VK_NULL_HANDLE;
}

bool Swapchain::isGood(VkResult result, const char* call) {
    mHasLostSurface |= result == VK_ERROR_SURFACE_LOST_KHR;
    if (result == VK_ERROR_SURFACE_LOST_KHR || result == VK_ERROR_OUT_OF_DATE_KHR) return false;
    check(result, call);
    return true;
}

// Without waiting: the newest image at the next refresh, else any immediately, else as if waiting.
std::optional<VkPresentModeKHR> Swapchain::presentMode() {
    if (mWaitsForDisplay) return VK_PRESENT_MODE_FIFO_KHR;
    uint32_t count = 0;
    std::vector<VkPresentModeKHR> modes;
    for (const bool isFilled : {false, true}) {
        modes.resize(count);
        const VkResult listed = vkGetPhysicalDeviceSurfacePresentModesKHR(
            mDevice.physical(), mSurface, &count, isFilled ? modes.data() : nullptr);
        if (!isGood(listed, "vkGetPhysicalDeviceSurfacePresentModesKHR")) return std::nullopt;
    }
    for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::find(modes.begin(), modes.end(), mode) != modes.end()) return mode;
    return VK_PRESENT_MODE_FIFO_KHR;
}

void Swapchain::setSurface(VkSurfaceKHR surface) {
    destroy();
    mSurface = surface;
    mHasLostSurface = false;
}

bool Swapchain::setWaitsForDisplay(bool waits) { return std::exchange(mWaitsForDisplay, waits) != waits; }

bool Swapchain::resize(uint32_t width, uint32_t height) {
    destroy();
    VkSurfaceCapabilitiesKHR can;
    const VkResult answer = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(mDevice.physical(), mSurface, &can);
    if (!isGood(answer, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")) return false;
    mExtent = can.currentExtent;
    if (mExtent.width == UINT32_MAX)
        mExtent = {std::clamp(width, can.minImageExtent.width, can.maxImageExtent.width),
                   std::clamp(height, can.minImageExtent.height, can.maxImageExtent.height)};
    if (mExtent.width == 0 || mExtent.height == 0) return false;

    const std::optional<VkPresentModeKHR> mode = presentMode();
    if (!mode) return false;

    constexpr VkImageUsageFlags kUsage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if ((can.supportedUsageFlags & kUsage) != kUsage)
        throw NoDeviceError(
            fmt::format("{}: images of this window cannot be drawn on and copied", mDevice.name()));
    VkSwapchainCreateInfoKHR create{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    create.surface = mSurface;
    create.minImageCount =
        can.maxImageCount ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    create.imageFormat = mFormat.format;
    create.imageColorSpace = mFormat.colorSpace;
    create.imageExtent = mExtent;
    create.imageArrayLayers = 1;
    create.imageUsage = kUsage;
    create.preTransform = can.currentTransform;
    create.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    create.presentMode = *mode;
    create.clipped = VK_FALSE; // screenshots include areas behind other windows
    VkSwapchainKHR made;
    if (!isGood(vkCreateSwapchainKHR(mDevice.handle(), &create, nullptr, &made), "vkCreateSwapchainKHR"))
        return false;
    mSwapchain = made;
    uint32_t count = 0;
    RELUME_VK(vkGetSwapchainImagesKHR(mDevice.handle(), mSwapchain, &count, nullptr));
    std::vector<VkImage> images(count);
    RELUME_VK(vkGetSwapchainImagesKHR(mDevice.handle(), mSwapchain, &count, images.data()));
    const ImageOptions options{
        .format = mFormat.format, .width = mExtent.width, .height = mExtent.height, .usage = kUsage};
    for (VkImage image : images) mImages.emplace_back(mDevice, image, options, "swapchain image");
    return true;
}

std::optional<uint32_t> Swapchain::acquire() {
    if (!mSwapchain) return std::nullopt;
    uint32_t image = 0;
    const VkResult result =
        vkAcquireNextImageKHR(mDevice.handle(), mSwapchain, UINT64_MAX, VK_NULL_HANDLE, mAcquired, &image);
    if (result != VK_SUBOPTIMAL_KHR && !isGood(result, "vkAcquireNextImageKHR")) return std::nullopt;
    const auto wait = [&] { return vkWaitForFences(mDevice.handle(), 1, &mAcquired, VK_TRUE, UINT64_MAX); };
    const VkResult waited = wait();
    if (waited != VK_SUCCESS) wait(); // the fence may not be destroyed before it is signaled
    check(waited, "vkWaitForFences");
    RELUME_VK(vkResetFences(mDevice.handle(), 1, &mAcquired));
    return image;
}

bool Swapchain::present(uint32_t image) {
    VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    present.swapchainCount = 1;
    present.pSwapchains = &mSwapchain;
    present.pImageIndices = &image;
    VkResult result;
    {
        const auto lock = mDevice.lockQueue();
        result = vkQueuePresentKHR(mDevice.queue(), &present);
    }
    return result != VK_SUBOPTIMAL_KHR && isGood(result, "vkQueuePresentKHR");
}

} // namespace relume::vk

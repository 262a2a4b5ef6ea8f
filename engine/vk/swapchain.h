// The images that a window shows.
#pragma once

#include "engine/vk/image.h"

#include <optional>

namespace relume::vk {

// A swapchain used without semaphores: each frame is acquired, drawn, waited for and presented before the
// next begins, so that the display always shows the response to the latest input.
class Swapchain {
  public:
    // `surface` and `device` must outlive the swapchain. With `waitsForDisplay` images are shown at the
    // display's rate, otherwise at once if the surface permits. Throws NoDeviceError if the device cannot
    // show images on the surface.
    Swapchain(const Device& device, VkSurfaceKHR surface, bool waitsForDisplay);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Returns whether the window system has destroyed the surface. Nothing can be drawn until setSurface().
    bool hasLostSurface() const { return mHasLostSurface; }
    // Sets another surface of the same kind; call resize() next. The old surface may be destroyed afterwards.
    void setSurface(VkSurfaceKHR surface);

    // Makes the images anew, as large as the surface, or of the given size where the surface leaves that
    // open. Call at first and whenever acquire() or present() fails. Returns false if the surface is lost or
    // has no area, as that of a minimized window: then nothing can be drawn.
    bool resize(uint32_t width, uint32_t height);

    // Sets `waitsForDisplay` as in the constructor. Returns whether it changed; if so, call resize().
    bool setWaitsForDisplay(bool waits);

    // Returns the format: 8 bits a channel, without conversion. Values are written as displayed, in sRGB.
    VkFormat format() const { return mFormat.format; }
    uint32_t width() const { return mExtent.width; }
    uint32_t height() const { return mExtent.height; }
    // Returns the images: color attachments and transfer sources, in an undefined layout when acquired.
    const std::vector<Image>& images() const { return mImages; }

    // Returns the number of the image to draw next, once nothing reads it; none if resize() is needed.
    std::optional<uint32_t> acquire();

    // Shows an image, in layout PRESENT_SRC, whose drawing has ended. Returns false if resize() is needed.
    bool present(uint32_t image);

  private:
    void destroy();
    // Returns how images are presented; none if isGood() fails.
    std::optional<VkPresentModeKHR> presentMode();
    // Returns false if another surface or size would help; otherwise behaves like check().
    bool isGood(VkResult result, const char* call);

    const Device& mDevice;
    VkSurfaceKHR mSurface;
    VkSurfaceFormatKHR mFormat;
    bool mWaitsForDisplay, mHasLostSurface = false;
    VkSwapchainKHR mSwapchain = VK_NULL_HANDLE;
    VkExtent2D mExtent{0, 0};
    std::vector<Image> mImages;
    VkFence mAcquired = VK_NULL_HANDLE;
};

} // namespace relume::vk

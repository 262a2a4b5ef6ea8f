// Images that a window shows.
#pragma once

#include "engine/vk/image.h"

#include <optional>

namespace relume::vk {

// A frame is acquired, drawn, waited for and presented: one after the other, without semaphores. What the
// display shows is then what the last input asked for.
class Swapchain {
  public:
    // `surface` must outlive this. `waitsForDisplay`: an image is shown when the display asks for one, else
    // at once where the surface can. Throws NoDeviceError when the device cannot show images on it.
    Swapchain(const Device& device, VkSurfaceKHR surface, bool waitsForDisplay);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // The window system has taken the surface away: nothing can be drawn until another is set.
    bool hasLostSurface() const { return mHasLostSurface; }
    // Another surface of the same kind, for which resize() must be called. The one before may go after this.
    void setSurface(VkSurfaceKHR surface);

    // Images anew, as large as the surface; of this size where it leaves that open. Call at first, and
    // whenever acquire() or present() say so. False where the surface has no area, as a minimised window's:
    // then there is nothing to draw on.
    bool resize(uint32_t width, uint32_t height);

    // As the constructor's. True: it is another choice than before, for which resize() must be called.
    bool setWaitsForDisplay(bool waits);

    // Of 8 bits a channel, not converted: values are written as the display takes them (sRGB).
    VkFormat format() const { return mFormat.format; }
    uint32_t width() const { return mExtent.width; }
    uint32_t height() const { return mExtent.height; }
    // Color attachments and sources of transfers, in an undefined layout when acquired.
    const std::vector<Image>& images() const { return mImages; }

    // The number of the image to draw next, which nothing reads any more. None: resize() first.
    std::optional<uint32_t> acquire();

    // Shows an image, in PRESENT_SRC, whose drawing has ended. False: resize() before the next.
    bool present(uint32_t image);

  private:
    void destroy();
    // As check(), but for what another surface or size mends; then false.
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

// Device images with one view: attachments, and textures to sample.
#pragma once

#include "engine/vk/device.h"

namespace relume::vk {

struct ImageOptions {
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    uint32_t width = 1, height = 1;
    uint32_t layers = 1;  // always viewed as a 2D array
    uint32_t samples = 1; // per pixel: a power of two
    uint32_t mips = 1;    // levels, each half as wide and high as the one before, rounded down to 1 or more
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
};

// Returns whether a depth format includes a stencil.
inline bool hasStencil(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
}

// An image, its view and, unless the image is foreign, its memory. Keeps a reference to the device.
class Image {
  public:
    Image() = default;
    // Throws OutOfMemory, or Error if the device cannot make such an image.
    Image(const Device& device, const ImageOptions& options, std::string_view name);
    // Makes a view of an image that is owned elsewhere, such as a swapchain's.
    Image(const Device& device, VkImage image, const ImageOptions& options, std::string_view name);
    ~Image() { destroy(); }
    Image(Image&& other) noexcept { *this = std::move(other); }
    Image& operator=(Image&& other) noexcept;

    VkImage handle() const { return mImage; }
    VkImageView view() const { return mView; }
    const ImageOptions& options() const { return mOptions; }
    VkImageAspectFlags aspect() const;

  private:
    void createView();
    void destroy();

    const Device* mDevice = nullptr;
    ImageOptions mOptions;
    VkImage mImage = VK_NULL_HANDLE;
    bool mIsForeign = false; // owned elsewhere
    MemoryPool::Range mMemory;
    VkImageView mView = VK_NULL_HANDLE;
};

// A sampler. It interpolates between mip levels too; images of integers need VK_FILTER_NEAREST.
class Sampler {
  public:
    Sampler() = default;
    Sampler(const Device& device, VkSamplerAddressMode addressU, VkSamplerAddressMode addressV,
            std::string_view name, VkFilter filter = VK_FILTER_LINEAR);
    ~Sampler() { destroy(); }
    Sampler(Sampler&& other) noexcept { *this = std::move(other); }
    Sampler& operator=(Sampler&& other) noexcept;

    VkSampler handle() const { return mSampler; }

  private:
    void destroy();

    const Device* mDevice = nullptr;
    VkSampler mSampler = VK_NULL_HANDLE;
};

} // namespace relume::vk

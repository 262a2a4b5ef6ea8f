#include "engine/vk/image.h"

#include "engine/vk/result.h"

#include <fmt/core.h>
#include <utility>

namespace relume::vk {

Image::Image(const Device& device, const ImageOptions& options, std::string_view name)
    : mDevice(&device), mOptions(options) {
    VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = options.format;
    create.extent = {options.width, options.height, 1};
    create.mipLevels = options.mips;
    create.arrayLayers = options.layers;
    create.samples = VkSampleCountFlagBits(options.samples);
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = options.usage;
    try {
        const uint32_t side = device.limits().maxImageDimension2D;
        if (options.width > side || options.height > side ||
            options.layers > device.limits().maxImageArrayLayers)
            throw Error(fmt::format("{}: {} x {} x {} texels asked for, {} allows {} x {} x {}", name,
                                    options.width, options.height, options.layers, device.name(), side, side,
                                    device.limits().maxImageArrayLayers));
        mImage = RELUME_VK_CREATE(vkCreateImage, device.handle(), create);
        VkMemoryRequirements requirements;
        vkGetImageMemoryRequirements(device.handle(), mImage, &requirements);
        if (requirements.size > device.info().largestAllocation)
            throw OutOfMemory(
                fmt::format("{}: {} x {} x {} texels take {} bytes, {} allows {} at once; ask for fewer",
                            name, options.width, options.height, options.layers, requirements.size,
                            device.name(), device.info().largestAllocation));
        mMemory = device.memory().allocate(
            requirements, device.memoryType(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT),
            MemoryKind::Image);
        RELUME_VK(vkBindImageMemory(device.handle(), mImage, mMemory.memory(), mMemory.offset()));
        createView();
    } catch (...) {
        destroy();
        throw;
    }
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(mImage), name);
    device.setName(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<uint64_t>(mView), name);
}

Image::Image(const Device& device, VkImage image, const ImageOptions& options, std::string_view name)
    : mDevice(&device), mOptions(options), mImage(image), mIsForeign(true) {
    createView();
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(mImage), name);
    device.setName(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<uint64_t>(mView), name);
}

void Image::createView() {
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = mImage;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    view.format = mOptions.format;
    view.subresourceRange = {aspect(), 0, mOptions.mips, 0, mOptions.layers};
    mView = RELUME_VK_CREATE(vkCreateImageView, mDevice->handle(), view);
}

VkImageAspectFlags Image::aspect() const {
    if (hasStencil(mOptions.format)) return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    return mOptions.format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Image& Image::operator=(Image&& other) noexcept {
    std::swap(mDevice, other.mDevice);
    std::swap(mOptions, other.mOptions);
    std::swap(mImage, other.mImage);
    std::swap(mIsForeign, other.mIsForeign);
    std::swap(mMemory, other.mMemory);
    std::swap(mView, other.mView);
    return *this;
}

void Image::destroy() {
    if (!mDevice) return;
    vkDestroyImageView(mDevice->handle(), mView, nullptr);
    if (!mIsForeign) vkDestroyImage(mDevice->handle(), mImage, nullptr);
    mMemory = {};
    mDevice = nullptr;
}

Sampler::Sampler(const Device& device, VkSamplerAddressMode addressU, VkSamplerAddressMode addressV,
                 std::string_view name, VkFilter filter)
    : mDevice(&device) {
    VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    create.magFilter = filter;
    create.minFilter = filter;
    create.addressModeU = addressU;
    create.addressModeV = addressV;
    create.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    create.mipmapMode =
        filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    create.maxLod = VK_LOD_CLAMP_NONE;
    mSampler = RELUME_VK_CREATE(vkCreateSampler, device.handle(), create);
    device.setName(VK_OBJECT_TYPE_SAMPLER, reinterpret_cast<uint64_t>(mSampler), name);
}

Sampler& Sampler::operator=(Sampler&& other) noexcept {
    std::swap(mDevice, other.mDevice);
    std::swap(mSampler, other.mSampler);
    return *this;
}

void Sampler::destroy() {
    if (mDevice) vkDestroySampler(mDevice->handle(), mSampler, nullptr);
    mDevice = nullptr;
}

} // namespace relume::vk

#include "engine/vk/buffer.h"

#include "engine/vk/result.h"

#include <fmt/core.h>
#include <utility>

namespace relume::vk {

static uint32_t memoryTypeFor(const Device& device, uint32_t typeBits, BufferUse use) {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (use) {
    case BufferUse::Device:
        return device.memoryType(typeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    case BufferUse::Upload:
        return device.memoryType(typeBits, kMapped);
    default:
        return device.memoryType(typeBits, kMapped, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    }
}

Buffer::Buffer(const Device& device, uint64_t bytes, BufferUse use, std::string_view name)
    : mDevice(&device), mBytes(bytes) {
    RELUME_CHECK_LT(0u, bytes);
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = bytes;
    create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                   VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                   VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    try {
        mBuffer = RELUME_VK_CREATE(vkCreateBuffer, device.handle(), create);
        VkMemoryRequirements requirements;
        vkGetBufferMemoryRequirements(device.handle(), mBuffer, &requirements);
        if (requirements.size > device.info().largestAllocation)
            throw OutOfMemory(fmt::format("{}: {} bytes asked for, {} allows {} at once", name,
                                          requirements.size, device.name(), device.info().largestAllocation));
        mMemory = device.memory().allocate(
            requirements, memoryTypeFor(device, requirements.memoryTypeBits, use),
            use == BufferUse::Device ? MemoryKind::Buffer : MemoryKind::MappedBuffer);
        RELUME_VK(vkBindBufferMemory(device.handle(), mBuffer, mMemory.memory(), mMemory.offset()));
    } catch (...) {
        destroy();
        throw;
    }
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(mBuffer), name);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(mDevice, other.mDevice);
    std::swap(mBuffer, other.mBuffer);
    std::swap(mMemory, other.mMemory);
    std::swap(mBytes, other.mBytes);
    return *this;
}

void Buffer::destroy() {
    if (!mDevice) return;
    vkDestroyBuffer(mDevice->handle(), mBuffer, nullptr);
    mMemory = {};
    mDevice = nullptr;
}

} // namespace relume::vk

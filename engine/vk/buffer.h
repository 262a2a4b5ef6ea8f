// Device buffers, allocated by intended use.
#pragma once

#include "engine/base/check.h"
#include "engine/vk/device.h"

#include <span>

namespace relume::vk {

enum class BufferUse {
    Device,   // device memory: storage, vertex, index, indirect, transfers either way
    Upload,   // written by the host, read by the device; mapped
    Readback, // written by the device, read by the host; mapped
};

// A buffer and its memory. Keeps a reference to the device, which must outlive it.
class Buffer {
  public:
    Buffer() = default;
    // `bytes` > 0. Throws OutOfMemory.
    Buffer(const Device& device, uint64_t bytes, BufferUse use, std::string_view name);
    ~Buffer() { destroy(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return mBuffer; }
    uint64_t bytes() const { return mBytes; }

    // Returns the mapped contents of an upload or readback buffer, as whole elements.
    template <typename T>
    std::span<T> map() const {
        void* const mapped = mMemory.mapped();
        RELUME_CHECK(mapped != nullptr);
        return {static_cast<T*>(mapped), mBytes / sizeof(T)};
    }

  private:
    void destroy();

    const Device* mDevice = nullptr;
    VkBuffer mBuffer = VK_NULL_HANDLE;
    MemoryPool::Range mMemory;
    uint64_t mBytes = 0;
};

} // namespace relume::vk

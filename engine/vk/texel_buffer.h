// Four floats a texel, read by index through the texture unit.
#pragma once

#include "engine/math/vector.h"
#include "engine/vk/buffer.h"

namespace relume::vk {

class TexelBuffer {
  public:
    TexelBuffer() = default;
    // Holds a copy of `texels`, at least one. Waits for the copy. Throws OutOfMemory; Error where the device
    // allows fewer texels.
    TexelBuffer(const Device& device, std::span<const vec4> texels, std::string_view name);
    ~TexelBuffer() { destroy(); }
    TexelBuffer(TexelBuffer&& other) noexcept { *this = std::move(other); }
    TexelBuffer& operator=(TexelBuffer&& other) noexcept;

    const VkBufferView& view() const { return mView; }

  private:
    void destroy();

    const Device* mDevice = nullptr;
    Buffer mBuffer;
    VkBufferView mView = VK_NULL_HANDLE;
};

} // namespace relume::vk

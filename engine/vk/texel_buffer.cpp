#include "engine/vk/texel_buffer.h"

#include "engine/base/error.h"
#include "engine/vk/result.h"
#include "engine/vk/upload.h"

#include <utility>

namespace relume::vk {

TexelBuffer::TexelBuffer(const Device& device, std::span<const vec4> texels, std::string_view name)
    : mDevice(&device) {
    if (texels.size() > device.limits().maxTexelBufferElements)
        throw Error(
            "{}: {} texels are more than the {} that {} allows in a buffer; use fewer terms or smaller maps",
            name, texels.size(), device.limits().maxTexelBufferElements, device.name());
    mBuffer = upload(device, texels, name);
    VkBufferViewCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    create.buffer = mBuffer.handle();
    create.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    create.range = VK_WHOLE_SIZE;
    RELUME_VK(vkCreateBufferView(device.handle(), &create, nullptr, &mView));
    device.setName(VK_OBJECT_TYPE_BUFFER_VIEW, reinterpret_cast<uint64_t>(mView), name);
}

TexelBuffer& TexelBuffer::operator=(TexelBuffer&& other) noexcept {
    std::swap(mDevice, other.mDevice);
    std::swap(mBuffer, other.mBuffer);
    std::swap(mView, other.mView);
    return *this;
}

void TexelBuffer::destroy() {
    if (!mDevice) return;
    vkDestroyBufferView(mDevice->handle(), mView, nullptr);
    mDevice = nullptr;
}

} // namespace relume::vk

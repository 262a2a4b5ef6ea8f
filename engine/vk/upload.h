// Data that stays on the device: copied there once, through staging buffers of bounded size.
#pragma once

#include "engine/vk/buffer.h"
#include "engine/vk/image.h"

#include <span>

namespace relume::vk {

// A device buffer, of at least one texel of four floats, that holds a copy of `bytes`. Waits for the copy:
// not for every frame. Throws OutOfMemory.
Buffer uploadBytes(const Device& device, std::span<const std::byte> bytes, std::string_view name);

template <typename T>
Buffer upload(const Device& device, std::span<const T> values, std::string_view name) {
    return uploadBytes(device, std::as_bytes(values), name);
}

// An image with these texels, level after level and of each layer after layer, ready for shader reads. Waits
// for the copy. Throws OutOfMemory.
Image uploadImage(const Device& device, const ImageOptions& options, std::span<const std::byte> texels,
                  std::string_view name);

// The first `bytes` of a device buffer, back on the host. Waits.
std::vector<std::byte> downloadBytes(const Device& device, const Buffer& buffer, uint64_t bytes);

template <typename T>
std::vector<T> download(const Device& device, const Buffer& buffer, size_t count) {
    std::vector<T> values(count);
    const std::vector<std::byte> bytes = downloadBytes(device, buffer, count * sizeof(T));
    std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(values)).begin());
    return values;
}

} // namespace relume::vk

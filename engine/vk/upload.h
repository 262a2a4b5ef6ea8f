// One-time transfers to and from device memory, through staging buffers.
#pragma once

#include "engine/vk/buffer.h"
#include "engine/vk/image.h"

#include <span>

namespace relume::vk {

// Returns a device buffer with a copy of `bytes`, of at least 16 bytes (one texel of four floats). Waits for
// the copy, so it is not for use in every frame. Throws OutOfMemory.
Buffer uploadBytes(const Device& device, std::span<const std::byte> bytes, std::string_view name);

template <typename T>
Buffer upload(const Device& device, std::span<const T> values, std::string_view name) {
    return uploadBytes(device, std::as_bytes(values), name);
}

// Returns an image with these texels, ordered by level, then layer, ready for reading by shaders. Waits for
// the copy. Throws OutOfMemory.
Image uploadImage(const Device& device, const ImageOptions& options, std::span<const std::byte> texels,
                  std::string_view name);

// Returns the first `bytes` bytes of a device buffer. Waits.
std::vector<std::byte> downloadBytes(const Device& device, const Buffer& buffer, uint64_t bytes);

template <typename T>
std::vector<T> download(const Device& device, const Buffer& buffer, size_t count) {
    std::vector<T> values(count);
    const std::vector<std::byte> bytes = downloadBytes(device, buffer, count * sizeof(T));
    std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(values)).begin());
    return values;
}

} // namespace relume::vk

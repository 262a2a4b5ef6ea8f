// Textures from image files.
#pragma once

#include "engine/scene/texture.h"

#include <filesystem>
#include <span>
#include <string>

namespace relume {

constexpr size_t kLargestTextureFile = size_t(1) << 29; // bytes

// Reads PNG or JPEG by content. Where the file has no alpha it is 1 in an sRGB image, and 0 in a linear one,
// whose channels are weights. Throws Error for anything truncated, corrupt, empty or absurd (more than
// kLongestTextureSide a side, more than the bytes can hold).
Texture readTexture(const std::filesystem::path& path, bool srgb);

// The same from a file's bytes; `name` stands for the file in errors.
Texture decodeTexture(std::span<const std::byte> bytes, const std::string& name, bool srgb);

} // namespace relume

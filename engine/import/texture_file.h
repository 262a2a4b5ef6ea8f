// Reading of textures from image files.
#pragma once

#include "engine/scene/texture.h"

#include <filesystem>
#include <span>
#include <string>

namespace relume {

constexpr size_t kLargestTextureFile = size_t(1) << 29; // bytes

// Reads PNG or JPEG, told apart by content. If the file has no alpha, alpha is 1 in an sRGB image, and 0 in a
// linear one, whose channels are weights. Throws Error if the file is truncated, corrupt, empty or absurd
// (more than kLongestTextureSide a side, more than the bytes can hold).
Texture readTexture(const std::filesystem::path& path, bool srgb);

// Reads a texture from a file's bytes; `name` names the file in errors.
Texture decodeTexture(std::span<const std::byte> bytes, const std::string& name, bool srgb);

} // namespace relume

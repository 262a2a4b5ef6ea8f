#include "engine/import/texture_file.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/image_codecs.h"
#include "engine/import/texture_check.h"
#include "engine/scene/texture.h"

#include <fmt/core.h>
#include <memory>
#include <stb_image.h>

namespace relume {
Texture decodeTexture(std::span<const std::byte> bytes, const std::string& name, bool srgb) {
    // stb_image would try many more formats, some of which it does not read safely.
    if (isPng(bytes))
        checkPng(bytes, name);
    else if (isJpeg(bytes))
        checkJpeg(bytes, name);
    else
        throw Error(fmt::format("{}: expected a PNG or JPEG image, found neither: convert it", name));
    if (bytes.size() > kLargestTextureFile)
        throw Error(fmt::format("{}: has {} bytes, expected at most {} for a texture: scale it down", name,
                                bytes.size(), kLargestTextureFile));
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = int(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        throw Error(fmt::format("{}: is not a valid image: {}", name, stbi_failure_reason()));
    checkImageSize(name, width, height, bytes.size());
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) throw Error(fmt::format("{}: is not a valid image: {}", name, stbi_failure_reason()));
    // Check again: stb_image reads the size anew, and a file may state it twice.
    checkImageSize(name, width, height, bytes.size());
    Texture texture{width, height, std::vector<uint32_t>(size_t(width) * size_t(height)), srgb};
    for (size_t i = 0; i < texture.texelCount(); i++)
        for (int channel = 0; channel < 4; channel++)
            texture.texels[i] |= uint32_t(pixels.get()[4 * i + size_t(channel)]) << (8 * channel);
    // stb_image fills a missing alpha with 255, but a missing weight is 0.
    const bool hasAlpha = channels == 2 || channels == 4;
    if (!srgb && !hasAlpha)
        for (uint32_t& texel : texture.texels) texel &= 0x00ffffff;
    return texture;
}

Texture readTexture(const std::filesystem::path& path, bool srgb) {
    return decodeTexture(readFile(path, kLargestTextureFile), path.string(), srgb);
}

} // namespace relume

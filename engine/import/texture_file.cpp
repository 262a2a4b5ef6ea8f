#include "engine/import/texture_file.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/image_codecs.h"
#include "engine/import/jpeg_check.h"
#include "engine/scene/texture.h"

#include <fmt/core.h>
#include <memory>
#include <new>
#include <stb_image.h>
#include <string_view>

namespace relume {

namespace {

// Throws for the last failure of the library's: std::bad_alloc if memory ran out, else Error.
[[noreturn]] void failJpeg(const std::string& name) {
    const std::string_view why = stbi_failure_reason();
    if (why == "outofmem") throw std::bad_alloc();
    throw Error(fmt::format("{}: is not a valid image: {}", name, why));
}

Texture decodeJpeg(std::span<const std::byte> bytes, const std::string& name, uint8_t missingAlpha) {
    checkJpeg(bytes, name);
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = int(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) failJpeg(name);
    checkTextureSize(name, width, height, bytes.size());
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) failJpeg(name);
    Texture texture{width, height, {}};
    texture.texels.reserve(texture.texelCount());
    for (size_t i = 0; i < texture.texelCount(); i++) {
        const stbi_uc* pixel = &pixels.get()[4 * i];
        texture.texels.push_back(uint32_t(missingAlpha) << 24 | uint32_t(pixel[2]) << 16 |
                                 uint32_t(pixel[1]) << 8 | uint32_t(pixel[0]));
    }
    return texture;
}

} // namespace

Texture decodeTexture(std::span<const std::byte> bytes, const std::string& name, bool srgb) {
    if (bytes.size() > kLargestTextureFile)
        throw Error(fmt::format("{}: has {} bytes, expected at most {} for a texture: scale it down", name,
                                bytes.size(), kLargestTextureFile));
    const uint8_t missingAlpha = srgb ? 255 : 0; // a linear image holds weights, of which a missing one is 0
    Texture texture;
    if (isPng(bytes))
        texture = decodePng(bytes, name, missingAlpha);
    else if (isJpeg(bytes))
        texture = decodeJpeg(bytes, name, missingAlpha);
    else // stb_image would try many more formats, some of which it does not read safely
        throw Error(fmt::format("{}: expected a PNG or JPEG image, found neither: convert it", name));
    texture.srgb = srgb;
    return texture;
}

Texture readTexture(const std::filesystem::path& path, bool srgb) {
    return decodeTexture(readFile(path, kLargestTextureFile), path.string(), srgb);
}

} // namespace relume

#include "engine/render/map_texture.h"

#include "engine/vk/upload.h"

#include <bit>

namespace relume {

vk::Image makeMapTexture(const vk::Device& device, std::span<const vec3> maps, uint32_t size, uint32_t layers,
                         std::string_view name) {
    RELUME_CHECK_EQ(maps.size(), size_t(size) * size * layers);
    std::vector<vec4> texels;
    texels.reserve(maps.size());
    for (const vec3& value : maps) texels.push_back(vec4(value, 0));
    return vk::uploadImage(device, {.width = size, .height = size, .layers = layers},
                           std::as_bytes(std::span(texels)), name);
}

vk::Image makeSurfaceTexture(const vk::Device& device, const Texture& texture, std::string_view name) {
    static_assert(std::endian::native == std::endian::little); // texels are words with R lowest
    const vk::ImageOptions options{.format =
                                       texture.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                                   .width = uint32_t(texture.width),
                                   .height = uint32_t(texture.height)};
    return vk::uploadImage(device, options, std::as_bytes(std::span(texture.texels)), name);
}

} // namespace relume

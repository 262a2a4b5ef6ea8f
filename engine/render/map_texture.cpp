#include "engine/render/map_texture.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"

#include <algorithm>
#include <bit>
#include <fmt/core.h>

namespace relume {

ViewMapTexture makeViewMapTexture(const vk::Device& device, const FactoredBrdf& brdf, std::string_view name) {
    ViewMapTexture packed;
    packed.isGray =
        std::ranges::all_of(brdf.viewMaps, [](const vec3& v) { return v.x == v.y && v.y == v.z; });
    const int channels = packed.isGray ? 1 : 3;
    packed.imagesPerLayer = uint32_t(channels * brdf.terms + 3) / 4;
    const uint32_t images = uint32_t(brdf.layers) * packed.imagesPerLayer;
    if (images > device.limits().maxImageArrayLayers)
        throw Error(fmt::format(
            "{}: {} layers of {} terms need {} images, {} holds at most {}; bake fewer materials or "
            "terms in a set",
            name, brdf.layers, brdf.terms, images, device.name(), device.limits().maxImageArrayLayers));
    std::vector<vec4> texels(images * brdf.mapTexels(), vec4(0));
    for (int layer = 0; layer < brdf.layers; layer++)
        for (int value = 0; value < channels * brdf.terms; value++) {
            const vec3* map = brdf.viewMap(layer, value / channels);
            const size_t image = uint32_t(layer) * packed.imagesPerLayer + uint32_t(value) / 4;
            for (size_t t = 0; t < brdf.mapTexels(); t++)
                texels[image * brdf.mapTexels() + t][value % 4] = map[t][value % channels];
        }
    const auto size = uint32_t(brdf.size);
    packed.image = vk::uploadImage(device, {.width = size, .height = size, .layers = images},
                                   std::as_bytes(std::span(texels)), name);
    return packed;
}

vk::Image makeSurfaceTexture(const vk::Device& device, const Texture& texture, std::string_view name) {
    static_assert(std::endian::native == std::endian::little); // texels are words with R lowest
    vk::ImageOptions options{.format = texture.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                             .width = uint32_t(texture.width),
                             .height = uint32_t(texture.height)};
    std::vector<uint32_t> texels;
    const std::vector<Texture> levels = makeMipLevels(texture);
    for (const Texture& level : levels) texels.insert(texels.end(), level.texels.begin(), level.texels.end());
    options.mips = uint32_t(levels.size());
    return vk::uploadImage(device, options, std::as_bytes(std::span(texels)), name);
}

} // namespace relume

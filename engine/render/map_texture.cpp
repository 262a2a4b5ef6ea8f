#include "engine/render/map_texture.h"

namespace relume {

vk::Image makeMapTexture(const vk::Device& device, std::span<const vec3> maps, uint32_t size, uint32_t layers,
                         std::string_view name) {
    RELUME_CHECK_EQ(maps.size(), size_t(size) * size * layers);
    vk::Image texture(device, {.width = size, .height = size, .layers = layers}, name);
    vk::Buffer staging(device, maps.size() * sizeof(vec4), vk::BufferUse::Upload, "map upload");
    const std::span<vec4> texels = staging.map<vec4>();
    for (size_t i = 0; i < maps.size(); i++) texels[i] = vec4(maps[i], 0);

    using enum vk::Stage;
    vk::Commands commands(device, "map upload");
    commands.begin();
    commands.transition(texture, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, Transfer,
                        Transfer);
    commands.copy(staging, texture);
    commands.transition(texture, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, Transfer, Compute);
    commands.submitAndWait();
    return texture;
}

} // namespace relume

// Light and view maps, and textures of surfaces, on the device.
#pragma once

#include "engine/scene/texture.h"
#include "engine/vk/image.h"

#include <span>

namespace relume {

// Uploads `layers` maps of size × size texels, ready for shader reads (RGBA, 32-bit float).
vk::Image makeMapTexture(const vk::Device& device, std::span<const vec3> maps, uint32_t size, uint32_t layers,
                         std::string_view name);

// Uploads a texture as it is: eight bits a channel, decoded by the device where it is sRGB.
vk::Image makeSurfaceTexture(const vk::Device& device, const Texture& texture, std::string_view name);

} // namespace relume

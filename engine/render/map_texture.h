// Light and view maps as a texture, one layer a term.
#pragma once

#include "engine/vk/commands.h"

#include <span>

namespace relume {

// Uploads `layers` maps of size × size texels, ready for shader reads (RGBA, 32-bit float).
vk::Image makeMapTexture(const vk::Device& device, std::span<const vec3> maps, uint32_t size, uint32_t layers,
                         std::string_view name);

} // namespace relume

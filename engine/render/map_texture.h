// View maps and textures of surfaces on the device.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/scene/texture.h"
#include "engine/vk/image.h"

namespace relume {

// View maps packed by fours, since a lookup costs as much for one value as for four. Of a layer's K maps,
// image i of the layer holds in its channels the terms 4i to 4i + 3 where all maps are gray; else values 4i
// to 4i + 3 of those that lie term after term, red, green and blue of each. Channels left over are zero.
struct ViewMapTexture {
    bool isGray = false;
    uint32_t imagesPerLayer = 0;
    vk::Image image; // layer after layer, 32-bit float
};

// Throws OutOfMemory, or Error where the device holds fewer images in an array.
ViewMapTexture makeViewMapTexture(const vk::Device& device, const FactoredBrdf& brdf, std::string_view name);

// Uploads a texture with all of its mip levels: eight bits a channel, decoded by the device where it is sRGB.
vk::Image makeSurfaceTexture(const vk::Device& device, const Texture& texture, std::string_view name);

} // namespace relume

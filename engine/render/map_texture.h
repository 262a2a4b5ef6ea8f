// View maps and textures of surfaces on the device.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/scene/texture.h"
#include "engine/vk/image.h"

namespace relume {

// View maps packed four to an image, since a lookup costs as much for one value as for four. If all maps are
// gray, image i of a layer holds terms 4i to 4i + 3 in its channels; otherwise it holds values 4i to 4i + 3
// of the sequence red, green, blue of each term. Channels left over are zero.
struct ViewMapTexture {
    bool isGray = false;
    uint32_t imagesPerLayer = 0;
    vk::Image image; // layer after layer, 32-bit float
};

// Packs and uploads the view maps of all layers. Throws OutOfMemory, or Error if the device supports fewer
// layers in an image.
ViewMapTexture makeViewMapTexture(const vk::Device& device, const FactoredBrdf& brdf, std::string_view name);

// Uploads a texture with all its mip levels, eight bits a channel; the device decodes sRGB.
vk::Image makeSurfaceTexture(const vk::Device& device, const Texture& texture, std::string_view name);

} // namespace relume

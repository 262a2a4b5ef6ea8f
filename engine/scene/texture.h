// Images on surfaces: eight bits a channel, as a device samples them.
#pragma once

#include "engine/math/vector.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace relume {

constexpr int kLongestTextureSide = 8192;

struct Texture {
    int width = 0, height = 0;
    std::vector<uint32_t> texels; // RGBA, R in the lowest eight bits; row by row from the top
    bool srgb = false;            // whether R, G and B are encoded; A never is

    size_t texelCount() const { return size_t(width) * size_t(height); }
};

// One texel, linear, in [0, 1].
vec4 fetch(const Texture& texture, int x, int y);

// What Vulkan's linear filter gives with repeating addresses: (0, 0) is the top left corner of the image, v
// goes down, sRGB is decoded before interpolation. Infinite or NaN coordinates count as 0.
vec4 sample(const Texture& texture, vec2 uv);

// Half as wide and high, rounded down to 1 or more: the next mip level. A texel is the mean of what it
// covers, of sides that are odd with a share of the texels that it cuts; sRGB is decoded before, and encoded
// after.
Texture halve(const Texture& texture);

// The texture and its mip levels, down to a single texel.
std::vector<Texture> makeMipLevels(const Texture& texture);

// Returns the mean of a texture over a pixel whose middle lies at uv, and its neighbors to the right and
// below this far away. GLSL twin, with the method: shaders/lib/texture_footprint.glsl.
vec4 sampleFootprint(std::span<const Texture> levels, vec2 uv, vec2 right, vec2 down);

// The mean of all texels, linear.
vec4 meanOf(const Texture& texture);

} // namespace relume

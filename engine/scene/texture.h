// Textures of eight bits a channel, filtered as a device filters them.
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
    bool srgb = false;            // whether R, G and B are sRGB-encoded; A never is

    size_t texelCount() const { return size_t(width) * size_t(height); }
};

// Returns one texel, linear, in [0, 1].
vec4 fetch(const Texture& texture, int x, int y);

// Returns what Vulkan's linear filter gives with repeating addresses: (0, 0) is the top left corner of the
// image, v goes down, sRGB is decoded before interpolation. Infinite or NaN coordinates count as 0.
vec4 sample(const Texture& texture, vec2 uv);

// Returns the next mip level: half as wide and high, rounded down to 1 or more. Each texel is the mean of the
// area that it covers; along odd sides, texels that are cut contribute in proportion. sRGB is decoded before
// and encoded after averaging.
Texture halve(const Texture& texture);

// Returns the texture followed by its mip levels, down to a single texel.
std::vector<Texture> makeMipLevels(const Texture& texture);

// Returns the mean of a texture over the footprint of a pixel whose center is at uv; `right` and `down` are
// the differences in uv to the neighbors on these sides. GLSL twin, with the method:
// shaders/lib/texture_footprint.glsl.
vec4 sampleFootprint(std::span<const Texture> levels, vec2 uv, vec2 right, vec2 down);

// Returns the mean of all texels, linear.
vec4 meanOf(const Texture& texture);

} // namespace relume

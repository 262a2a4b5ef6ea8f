#include "engine/scene/texture.h"

#include "engine/base/check.h"
#include "engine/math/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {
namespace {

// As in shaders/lib/texture_footprint.glsl.
constexpr float kMostTaps = 16, kMostFootprint = 1e6f;

std::array<float, 256> makeSrgbTable() {
    std::array<float, 256> table;
    for (int byte = 0; byte < 256; byte++) table[size_t(byte)] = decodeSrgb(float(byte) / 255);
    return table;
}

// Returns the nearest byte of a linear value, sRGB-encoded if asked.
uint32_t encode(float value, bool srgb) {
    return uint32_t(std::lround(255 * (srgb ? encodeSrgb(value) : value)));
}

// The texels that one texel of half the resolution covers along an axis: up to three, with their shares.
struct Cover {
    int first, count;
    std::array<float, 3> shares;
};

Cover cover(int index, int size) {
    const int half = std::max(size / 2, 1);
    Cover cover{index * size / half, 0, {}};
    // Positions are in units in which a texel is `half` long and one of half the resolution `size` long.
    for (int texel = cover.first; texel * half < (index + 1) * size; texel++) {
        const int low = std::max(texel * half, index * size),
                  high = std::min((texel + 1) * half, (index + 1) * size);
        cover.shares[size_t(cover.count++)] = float(high - low) / float(size);
    }
    return cover;
}

// Bilinear footprint of a coordinate along an axis: the texels whose centers are before and after it.
struct Footprint {
    int before, after;
    float weight; // weight of `after`
};

Footprint footprint(float coordinate, int size) {
    const float turn = std::isfinite(coordinate) ? coordinate - std::floor(coordinate) : 0;
    const float place = turn * float(size) - 0.5f, before = std::floor(place);
    return {(int(before) + size) % size, (int(before) + 1) % size, place - before};
}

} // namespace

vec4 fetch(const Texture& texture, int x, int y) {
    static const std::array<float, 256> kSrgb = makeSrgbTable();
    RELUME_CHECK(x >= 0 && x < texture.width && y >= 0 && y < texture.height);
    const uint32_t texel = texture.texels[size_t(y) * size_t(texture.width) + size_t(x)];
    vec4 value;
    for (int channel = 0; channel < 4; channel++) {
        const uint32_t byte = texel >> (8 * channel) & 0xff;
        value[channel] = texture.srgb && channel < 3 ? kSrgb[byte] : float(byte) / 255;
    }
    return value;
}

vec4 sample(const Texture& texture, vec2 uv) {
    RELUME_CHECK(texture.width > 0 && texture.height > 0);
    const Footprint x = footprint(uv.x, texture.width), y = footprint(uv.y, texture.height);
    const vec4 upper =
        glm::mix(fetch(texture, x.before, y.before), fetch(texture, x.after, y.before), x.weight);
    const vec4 lower =
        glm::mix(fetch(texture, x.before, y.after), fetch(texture, x.after, y.after), x.weight);
    return glm::mix(upper, lower, y.weight);
}

Texture halve(const Texture& texture) {
    RELUME_CHECK(texture.width > 0 && texture.height > 0);
    Texture half{std::max(texture.width / 2, 1), std::max(texture.height / 2, 1), {}, texture.srgb};
    half.texels.reserve(half.texelCount());
    std::vector<Cover> columns;
    for (int x = 0; x < half.width; x++) columns.push_back(cover(x, texture.width));
    for (int y = 0; y < half.height; y++) {
        const Cover down = cover(y, texture.height);
        for (const Cover& across : columns) {
            vec4 sum(0);
            for (int j = 0; j < down.count; j++)
                for (int i = 0; i < across.count; i++)
                    sum += across.shares[size_t(i)] * down.shares[size_t(j)] *
                           fetch(texture, across.first + i, down.first + j);
            sum = glm::clamp(sum, 0.0f, 1.0f);
            uint32_t texel = 0;
            for (int channel = 0; channel < 4; channel++)
                texel |= encode(sum[channel], texture.srgb && channel < 3) << (8 * channel);
            half.texels.push_back(texel);
        }
    }
    return half;
}

std::vector<Texture> makeMipLevels(const Texture& texture) {
    std::vector<Texture> levels{texture};
    while (levels.back().texelCount() > 1) levels.push_back(halve(levels.back()));
    return levels;
}

vec4 sampleFootprint(std::span<const Texture> levels, vec2 uv, vec2 right, vec2 down) {
    const vec2 size(levels[0].width, levels[0].height);
    const vec2 a = glm::clamp(right * size, -kMostFootprint, kMostFootprint),
               b = glm::clamp(down * size, -kMostFootprint, kMostFootprint);
    const float p = glm::dot(a, a), q = glm::dot(b, b), r = glm::dot(a, b);
    const float major = std::sqrt(0.5f * (p + q + std::sqrt((p - q) * (p - q) + 4 * r * r)));
    const float minor = std::abs(a.x * b.y - a.y * b.x) / std::max(major, 1e-6f);
    const float width = std::max({minor, major / kMostTaps, 1.0f});
    const float taps = std::clamp(std::ceil(major / width), 1.0f, kMostTaps);
    const float turn = 0.5f * std::atan2(2 * r, p - q);
    const vec2 along = (std::cos(turn) * a + std::sin(turn) * b) / size;
    const float level = std::min(std::log2(width), float(levels.size() - 1));
    const size_t fine = size_t(level), coarse = std::min(fine + 1, levels.size() - 1);
    vec4 sum(0);
    for (float tap = 0.5f; tap < taps; tap++) {
        const vec2 place = uv + (tap / taps - 0.5f) * along;
        sum += glm::mix(sample(levels[fine], place), sample(levels[coarse], place), level - float(fine));
    }
    return sum / taps;
}

vec4 meanOf(const Texture& texture) {
    RELUME_CHECK(texture.width > 0 && texture.height > 0);
    glm::dvec4 sum(0);
    for (int y = 0; y < texture.height; y++)
        for (int x = 0; x < texture.width; x++) sum += glm::dvec4(fetch(texture, x, y));
    return vec4(sum / double(texture.texelCount()));
}

} // namespace relume

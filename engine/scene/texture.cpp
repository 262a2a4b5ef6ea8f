#include "engine/scene/texture.h"

#include "engine/base/check.h"

#include <array>
#include <cmath>

namespace relume {
namespace {

// IEC 61966-2-1, of a byte.
float decodeSrgb(int byte) {
    const float value = float(byte) / 255;
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

std::array<float, 256> makeSrgbTable() {
    std::array<float, 256> table;
    for (int byte = 0; byte < 256; byte++) table[size_t(byte)] = decodeSrgb(byte);
    return table;
}

// Where along one axis of `size` texels a coordinate falls: the texel before it, and how far it is beyond
// that texel's centre.
struct Footprint {
    int before, after;
    float weight; // of `after`
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

vec4 meanOf(const Texture& texture) {
    RELUME_CHECK(texture.width > 0 && texture.height > 0);
    glm::dvec4 sum(0);
    for (int y = 0; y < texture.height; y++)
        for (int x = 0; x < texture.width; x++) sum += glm::dvec4(fetch(texture, x, y));
    return vec4(sum / double(texture.texelCount()));
}

} // namespace relume

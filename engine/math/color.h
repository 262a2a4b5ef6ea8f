// Luminance and encoding of colors with sRGB primaries (IEC 61966-2-1).
#pragma once

#include "engine/math/vector.h"

#include <cmath>

namespace relume {

// Returns the luminance of a linear color.
inline float luminance(vec3 linear) { return glm::dot(linear, vec3(0.2126f, 0.7152f, 0.0722f)); }

// Converts one channel, in [0, 1], from linear to sRGB-encoded.
inline float encodeSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

// Inverts encodeSrgb().
inline float decodeSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

} // namespace relume

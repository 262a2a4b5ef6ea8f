// The Morton order of a cube face's texels, in which every aligned square whose side is a power of two is
// contiguous.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Returns the coordinates of the index-th texel: even bits are x, odd bits y.
inline ivec2 mortonPlace(uint32_t index) {
    const auto evenBits = [](uint32_t bits) {
        bits &= 0x55555555u;
        bits = (bits | bits >> 1) & 0x33333333u;
        bits = (bits | bits >> 2) & 0x0f0f0f0fu;
        bits = (bits | bits >> 4) & 0x00ff00ffu;
        return int((bits | bits >> 8) & 0x0000ffffu);
    };
    return {evenBits(index), evenBits(index >> 1)};
}

} // namespace relume

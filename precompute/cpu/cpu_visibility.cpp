#include "precompute/cpu/cpu_visibility.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace relume {

namespace {

constexpr size_t kTile = RayTracer::kStream; // 16 × 16 texels
static_assert(kTile % 64 == 0);
using Reach = std::array<float, kTile>;

// Packs bit 8i of `bytes` into bit i.
uint64_t gather(uint64_t bytes) { return bytes * 0x0102040810204080ull >> 56; }

// Packs one bit per ray: whether its reach is still positive.
void packFree(const Reach& reach, uint64_t* bits) {
    std::array<uint8_t, kTile> isFree;
    for (size_t i = 0; i < kTile; i++) isFree[i] = reach[i] > 0;
    for (size_t word = 0; word < kTile / 64; word++) {
        bits[word] = 0;
        for (size_t byte = 0; byte < 8; byte++) {
            uint64_t eight;
            std::memcpy(&eight, &isFree[word * 64 + byte * 8], 8);
            static_assert(std::endian::native == std::endian::little);
            bits[word] |= gather(eight) << (8 * byte);
        }
    }
}

} // namespace

CpuVisibility::CpuVisibility(const Mesh& occluder, int size)
    : mTracer(std::array<const Mesh*, 1>{&occluder}) {
    RELUME_CHECK(size >= 16 && std::has_single_bit(unsigned(size)));
    for (int face = 0; face < kCubeFaces; face++)
        for (uint32_t i = 0; i < uint32_t(size * size); i++) {
            const ivec2 place = mortonPlace(i);
            const vec3 direction = cubeTexelDirection(face, place.x, place.y, size);
            mX.push_back(direction.x), mY.push_back(direction.y), mZ.push_back(direction.z);
        }
}

uint64_t CpuVisibility::trace(vec3 origin, vec3 normal, std::span<uint64_t> bits) const {
    RELUME_CHECK_EQ(bits.size() * 64, texels());
    constexpr float kTraced = std::numeric_limits<float>::infinity(), kLeftOut = -1;
    uint64_t rays = 0;
    alignas(64) Reach reach;
    for (size_t tile = 0; tile < texels(); tile += kTile) {
        const float *x = &mX[tile], *y = &mY[tile], *z = &mZ[tile];
        int above = 0;
        for (size_t i = 0; i < kTile; i++) {
            // Evaluated like glm::dot, so that texels at the horizon agree with the twin.
            const bool isAbove = x[i] * normal.x + y[i] * normal.y + z[i] * normal.z > 0;
            reach[i] = isAbove ? kTraced : kLeftOut;
            above += isAbove;
        }
        if (above == 0) {
            std::fill_n(&bits[tile / 64], kTile / 64, 0);
            continue;
        }
        mTracer.occluded(origin, x, y, z, reach);
        packFree(reach, &bits[tile / 64]);
        rays += uint64_t(above);
    }
    return rays;
}

} // namespace relume

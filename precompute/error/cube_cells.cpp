#include "precompute/error/cube_cells.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "precompute/cpu/morton.h"

#include <bit>

namespace relume {

CubeCells::CubeCells(int faceSize) : size(faceSize) {
    RELUME_CHECK(std::has_single_bit(unsigned(size)));
    for (int face = 0; face < kCubeFaces; face++)
        for (uint32_t i = 0; i < uint32_t(size * size); i++) {
            const ivec2 place = mortonPlace(i);
            directions.push_back(cubeTexelDirection(face, place.x, place.y, size));
            solidAngles.push_back(cubeTexelSolidAngle(place.x, place.y, size));
            texels.push_back(uint32_t(cubeTexelIndex(face, place.x, place.y, size)));
        }
}

std::vector<vec3> CubeCells::ordered(const LightCube& cube) const {
    RELUME_CHECK_EQ(cube.size, size);
    std::vector<vec3> values;
    values.reserve(count());
    for (const uint32_t texel : texels) values.push_back(cube.radiance[texel]);
    return values;
}

float shareOfOnes(std::span<const uint64_t> bits, size_t first, size_t count) {
    const uint64_t word = bits[first / 64] >> (first % 64);
    const uint64_t mask = count == 64 ? ~uint64_t(0) : (uint64_t(1) << count) - 1;
    return float(std::popcount(word & mask)) / float(count);
}

} // namespace relume

#include "precompute/error/lit_cells.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "precompute/cpu/cpu_visibility.h"

#include <bit>

namespace relume {

std::vector<LitCell> litCells(const CubeCells& cells, const CubeCells& lighting,
                              std::span<const uint64_t> bits, const TangentFrame& frame) {
    const size_t bitsPerCell = bits.size() * 64 / cells.count();
    const size_t cellsPerTexel = cells.count() / lighting.count();
    RELUME_CHECK(bitsPerCell >= 1 && bitsPerCell <= 64);
    std::vector<LitCell> lit;
    for (size_t i = 0; i < cells.count(); i++) {
        const float share = shareOfOnes(bits, i * bitsPerCell, bitsPerCell);
        if (share == 0) continue;
        const vec3 local = frame.toLocal(cells.directions[i]);
        if (!(local.z > 0)) continue;
        lit.push_back({lighting.texels[i / cellsPerTexel], share * local.z * cells.solidAngles[i], local});
    }
    return lit;
}

std::vector<MapPlace> placesOf(std::span<const LitCell> lit, int mapSize, DiskMapping mapping) {
    std::vector<MapPlace> places;
    places.reserve(lit.size());
    for (const LitCell& cell : lit) places.push_back(placeInMap(mapSize, mapping, cell.local));
    return places;
}

std::vector<vec3> transportOf(std::span<const LitCell> lit, std::span<const MapPlace> places,
                              const vec3* lightMap, size_t texels) {
    std::vector<vec3> transport(texels, vec3(0));
    for (size_t i = 0; i < lit.size(); i++)
        transport[lit[i].texel] += lit[i].weight * lookupMap(lightMap, places[i]);
    return transport;
}

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

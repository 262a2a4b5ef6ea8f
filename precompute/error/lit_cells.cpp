#include "precompute/error/lit_cells.h"

#include "engine/base/check.h"

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

} // namespace relume

// What a point can be lit from: the cells of a cube that are free and above its horizon.
#pragma once

#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"
#include "precompute/error/cube_cells.h"

namespace relume {

struct LitCell {
    uint32_t texel; // of the lighting cube, row by row
    float weight;   // visible share · cosine · solid angle
    vec3 local;     // unit direction of its center, z > 0
};

// `cells` are the evaluations of transport, 1, 4 or 16 a texel of `lighting`; `bits` as CpuVisibility gives
// them, 1, 4, 16 or 64 a cell.
std::vector<LitCell> litCells(const CubeCells& cells, const CubeCells& lighting,
                              std::span<const uint64_t> bits, const TangentFrame& frame);

// Where `lit` lie in light maps of this kind.
std::vector<MapPlace> placesOf(std::span<const LitCell> lit, int mapSize, DiskMapping mapping);

// One term's transport, 6 F² texels row by row: transportVector in
// precompute/twins/transport_twin.h, in another order of sums.
std::vector<vec3> transportOf(std::span<const LitCell> lit, std::span<const MapPlace> places,
                              const vec3* lightMap, size_t texels);

} // namespace relume

// The cells of a cube from which a point can be lit: unoccluded and above its horizon.
#pragma once

#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"
#include "precompute/error/cube_cells.h"

namespace relume {

struct LitCell {
    uint32_t texel; // of the lighting cube, in row order
    float weight;   // visible share · cosine · solid angle
    vec3 local;     // unit direction of its center in the local frame, z > 0
};

// Returns the lit cells. `cells` are the evaluations of transport, 1, 4 or 16 per texel of `lighting`; `bits`
// are from CpuVisibility, 1, 4, 16 or 64 per cell.
std::vector<LitCell> litCells(const CubeCells& cells, const CubeCells& lighting,
                              std::span<const uint64_t> bits, const TangentFrame& frame);

// Returns the places of `lit` in light maps of this size and mapping.
std::vector<MapPlace> placesOf(std::span<const LitCell> lit, int mapSize, DiskMapping mapping);

// Returns one term's transport, 6 F² texels in row order: transportVector() of
// precompute/twins/transport_twin.h, summed in another order.
std::vector<vec3> transportOf(std::span<const LitCell> lit, std::span<const MapPlace> places,
                              const vec3* lightMap, size_t texels);

} // namespace relume

// The texels of a cube in Morton order, called cells, and those from which a point can be lit: unoccluded and
// above its horizon.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"

#include <cstdint>
#include <span>
#include <vector>

namespace relume {

// The directions of a cube's texels. Cells are ordered face by face, each along mortonPlace(): the 4^n cells
// inside a cell of a cube 2^n times coarser are consecutive.
struct CubeCells {
    int size; // cells per side of a face, a power of two
    std::vector<vec3> directions;
    std::vector<float> solidAngles;
    std::vector<uint32_t> texels; // per cell: its index in row order, as in LightCube

    explicit CubeCells(int faceSize);
    size_t count() const { return directions.size(); }

    // Returns the radiance of a cube of this size in the order of cells.
    std::vector<vec3> ordered(const LightCube& cube) const;
};

// Returns the share of ones among the bits [first, first + count). `count` is 1 or a power of four up to 64;
// `first` is a multiple of it.
float shareOfOnes(std::span<const uint64_t> bits, size_t first, size_t count);

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

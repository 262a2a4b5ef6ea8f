// A BRDF as a matrix over the directions of a disk map.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/brdf.h"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace relume {

// channel[c](i, o) = f_c(ωi, ωo), or its mean around there, for the n texel centers that lie inside the map's
// domain.
struct BrdfTable {
    int size = 0; // S
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<ivec2> texels;               // n: (x, y) of each direction
    std::vector<vec3> directions;            // n
    std::vector<float> solidAngles;          // n: of each direction's texel, sr
    std::array<Eigen::MatrixXf, 3> channels; // n × n each
    float asymmetry = 0;                     // max over channels of ‖M - Mᵀ‖ / ‖M‖ (Frobenius)
};

// Side of a map, S. The largest makes three matrices of 41 MB (orthographic) or 67 MB (polar).
constexpr int kMinMapSize = 4, kMaxMapSize = 64;

// What of a BRDF: a base color texture multiplies the base and leaves the rest.
enum class BrdfPart { All, Rest, Base };

// What stands in for f over a pair of texels: its value at their centers, or the mean of f cosθi cosθo over
// four pairs of places in them, divided by that of cosθi cosθo. The mean costs four times as much and, unlike
// the value, does not let ridges of f near grazing, narrower than a texel, spread over all of it.
enum class TexelValue { Center, Mean };

// Throws UsageError for a size outside these.
BrdfTable tabulate(const Brdf& brdf, int size, DiskMapping mapping, TexelValue value = TexelValue::Center,
                   BrdfPart part = BrdfPart::All);

// For every texel of the map, row by row, the index of the nearest direction's texel: itself inside the
// disk, the nearest inside texel (the first of equals) outside it. Maps are extended so, since bilinear
// lookups near the rim read texels outside.
std::vector<int> nearestDirections(const BrdfTable& table);

} // namespace relume

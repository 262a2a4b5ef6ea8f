// A BRDF as a matrix over the directions of a disk map.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/brdf.h"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace relume {

// channel[c](i, o) = f_c(ωi, ωo) for the n texel centres that lie inside the map's domain.
struct BrdfTable {
    int size = 0; // S
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<ivec2> texels;               // n: (x, y) of each direction
    std::vector<vec3> directions;            // n
    std::array<Eigen::MatrixXf, 3> channels; // n × n each
    float asymmetry = 0;                     // max over channels of ‖M - Mᵀ‖ / ‖M‖ (Frobenius)
};

BrdfTable tabulate(const Brdf& brdf, int size, DiskMapping mapping);

} // namespace relume

// Tabulates a BRDF as a matrix over pairs of hemisphere directions.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/brdf.h"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace relume {

// channel[c](i, o) = f_c(ωi, ωo), at texel centers or averaged over texels, for the n texels whose centers
// lie inside the map's domain.
struct BrdfTable {
    int size = 0; // S
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<ivec2> texels;               // n: (x, y) of each direction's texel
    std::vector<vec3> directions;            // n: texel centers
    std::vector<float> solidAngles;          // n: of each direction's texel, sr
    std::array<Eigen::MatrixXf, 3> channels; // n × n each
    bool isIsotropic = true;                 // whether the BRDF is
    float asymmetry = 0;                     // max over channels of ‖M - Mᵀ‖ / ‖M‖ (Frobenius)
};

// Limits of S. The largest needs three matrices of 41 MB (orthographic) or 67 MB (polar).
constexpr int kMinMapSize = 4, kMaxMapSize = 64;

// The part of a BRDF to tabulate: a base color texture multiplies the base and leaves the rest.
enum class BrdfPart { All, Rest, Base };

// The value that represents f over a pair of texels: the value at their centers, or the mean of f cosθi cosθo
// over four pairs of points in them, divided by the mean of cosθi cosθo. Means take four times as long;
// ridges of f near grazing that are narrower than a texel then do not fill it.
enum class TexelValue { Center, Mean };

// Tabulates a BRDF. Entries of an isotropic one that quarter turns of an orthographic or equal-area map
// exchange are equal: one of each four is evaluated. Throws UsageError if `size` is outside kMinMapSize to
// kMaxMapSize.
BrdfTable tabulate(const Brdf& brdf, int size, DiskMapping mapping, TexelValue value = TexelValue::Center,
                   BrdfPart part = BrdfPart::All);

// Returns, for every texel of the map in row order, the index of the nearest direction: its own inside the
// disk, the nearest one (the first of equals) outside. Extends maps beyond the disk, since bilinear lookups
// near the rim read texels there.
std::vector<int> nearestDirections(const BrdfTable& table);

} // namespace relume

// A BRDF as a sum of K products of a light map and a view map.
#pragma once

#include "engine/math/disk_map.h"

#include <array>
#include <vector>

namespace relume {

constexpr int kMaxTerms = 32; // K

// f(ωi, ωo) ≈ Σk lightMap_k(ωi) viewMap_k(ωo), per colour channel; ωi and ωo in the local frame.
// Maps are `size` × `size` texels, row by row, term after term, already extended beyond the disk's rim
// so that bilinear lookups near it need no special case.
struct FactoredBrdf {
    int size = 0;  // S, texels a side
    int terms = 0; // K
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<vec3> lightMaps;                   // terms × size × size
    std::vector<vec3> viewMaps;                    // terms × size × size
    std::vector<std::array<float, 3>> eigenvalues; // per term: one per channel, signed, by falling size

    size_t mapTexels() const { return size_t(size) * size_t(size); }
};

// Bilinear lookup of one map of size × size texels, clamped at its border (polar maps wrap in x).
vec3 lookupMap(const vec3* map, int size, DiskMapping mapping, vec3 local);

// The K-term sum at a pair of local directions; not clamped, so it can be negative.
vec3 evaluate(const FactoredBrdf& brdf, vec3 incoming, vec3 outgoing);

} // namespace relume

// BRDFs as sums of K products of a light map and a view map.
#pragma once

#include "engine/math/disk_map.h"

#include <array>
#include <vector>

namespace relume {

constexpr int kMaxTerms = 32; // K

// f_j(ωi, ωo) ≈ Σk lightMap_k(ωi) viewMap_jk(ωo), per color channel; ωi and ωo in the local frame. The
// layers j are BRDFs, or parts of one, that share their light maps: what is baked with them serves all. Maps
// are `size` × `size` texels, row by row, term after term, layer after layer, already extended beyond the
// disk's rim so that bilinear lookups near it need no special case.
struct FactoredBrdf {
    int size = 0;  // S, texels a side
    int terms = 0; // K
    int layers = 1;
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<vec3> lightMaps; // terms × size × size
    std::vector<vec3> viewMaps;  // layers × terms × size × size
    // Per term, of the matrix that was factored, one per channel, by falling size: eigenvalues, signed, of a
    // single reciprocal BRDF under symmetric weights; singular values otherwise.
    std::vector<std::array<float, 3>> eigenvalues;

    size_t mapTexels() const { return size_t(size) * size_t(size); }
    const vec3* lightMap(int term) const { return &lightMaps[size_t(term) * mapTexels()]; }
    const vec3* viewMap(int layer, int term) const {
        return &viewMaps[size_t(layer * terms + term) * mapTexels()];
    }
};

// What a bilinear lookup reads: texels of two rows, left and right of each, and how far it lies between them.
struct MapPlace {
    std::array<int, 4> texels;
    vec2 weight;
};
MapPlace placeInMap(int size, DiskMapping mapping, vec3 local);
vec3 lookupMap(const vec3* map, const MapPlace& place);

// Bilinear lookup of one map of size × size texels, clamped at its border (polar maps wrap in x).
vec3 lookupMap(const vec3* map, int size, DiskMapping mapping, vec3 local);

// The K-term sum of a layer at a pair of local directions; not clamped, so it can be negative.
vec3 evaluate(const FactoredBrdf& brdf, vec3 incoming, vec3 outgoing, int layer = 0);

// Returns whether no texel of any map is negative, so that no sum of terms is either.
bool isNonnegative(const FactoredBrdf& brdf);

} // namespace relume

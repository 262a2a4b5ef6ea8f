// BRDFs as sums of K products of a light map and a view map.
#pragma once

#include "engine/math/disk_map.h"

#include <array>
#include <vector>

namespace relume {

constexpr int kMostTerms = 32; // K

// Light and view maps of one or more BRDFs f_j: f_j(ωi, ωo) ≈ Σk lightMap_k(ωi) viewMap_jk(ωo), per color
// channel, with ωi and ωo in the local frame. The layers j are BRDFs, or parts of one, that share light maps
// and thus transport. Maps have `size` × `size` texels, stored row by row, term after term, layer after
// layer, and are extended beyond the disk's rim so that bilinear lookups need no special case there.
struct FactoredBrdf {
    int size = 0;  // S, texels per side
    int terms = 0; // K
    int layers = 1;
    DiskMapping mapping = DiskMapping::Orthographic;
    std::vector<vec3> lightMaps; // terms × size × size
    std::vector<vec3> viewMaps;  // layers × terms × size × size
    // Per term and channel, in order of falling magnitude: signed eigenvalues of the factored matrix if it is
    // that of a single reciprocal BRDF with symmetric weights, singular values otherwise.
    std::vector<std::array<float, 3>> eigenvalues;

    size_t mapTexels() const { return size_t(size) * size_t(size); }
    const vec3* lightMap(int term) const { return &lightMaps[size_t(term) * mapTexels()]; }
    const vec3* viewMap(int layer, int term) const {
        return &viewMaps[size_t(layer * terms + term) * mapTexels()];
    }
};

// The four texels that a bilinear lookup reads (left and right of the upper row, then of the lower one) and
// the interpolation weights between them.
struct MapPlace {
    std::array<int, 4> texels;
    vec2 weight;
};
MapPlace placeInMap(int size, DiskMapping mapping, vec3 local);
vec3 lookupMap(const vec3* map, const MapPlace& place);

// Looks up one map of size × size texels bilinearly, clamped at its border (polar maps wrap in x).
vec3 lookupMap(const vec3* map, int size, DiskMapping mapping, vec3 local);

// Returns the K-term sum of a layer for a pair of local directions. It is not clamped and can be negative.
vec3 evaluate(const FactoredBrdf& brdf, vec3 incoming, vec3 outgoing, int layer = 0);

// Returns whether no texel of any map is negative, so that no sum of terms is negative either.
bool isNonnegative(const FactoredBrdf& brdf);

} // namespace relume

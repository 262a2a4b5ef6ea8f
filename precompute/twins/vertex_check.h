// Recomputes every stage of a vertex on the CPU, to verify a bake.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/twins/transport_twin.h"

namespace relume {

struct TermReference {
    std::vector<vec3> transport;    // 6 · F² values before the Haar transform
    std::vector<vec3> coefficients; // after it
    std::vector<uint16_t> selected; // the asset.coefficients largest, as rows keep them
    PackedRow row;
};

struct VertexReference {
    std::vector<uint8_t> visibility;  // 6 · visibilitySize²
    std::vector<TermReference> terms; // K
};

// Recomputes vertex `vertex` of part `part` and set `set` with the asset's own options, factors and frames.
// `occluder` traces the asset's occluder.
VertexReference recomputeVertex(const Asset& asset, size_t part, size_t set, size_t vertex,
                                const RayTracer& occluder);

// Returns the stored row of a vertex and term.
PackedRow storedRow(const SparseTransport& transport, size_t vertex, size_t term);

} // namespace relume

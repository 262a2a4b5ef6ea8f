// The CPU twin of a bounce of light, one vertex and term at a time; deliberately naive.
#pragma once

#include "engine/render/appearance.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Returns all kBounceCoefficients of the row that BounceGather gathers for a term of a set at a vertex,
// before any are dropped. Sums over the centers of 6 · size² texels of directions, and over the rows of all
// three corners of each triangle hit. `from` is as for BounceGather::gather(), `gains` from sourceGains(),
// `tracer` of the asset's partMeshes().
std::vector<vec3> bouncedVector(const Asset& asset, const Appearance& bound,
                                std::span<const std::vector<vec3>> gains, const RayTracer& tracer,
                                std::span<const SparseTransport> from, size_t part, uint32_t vertex,
                                size_t set, int term, int size);

} // namespace relume

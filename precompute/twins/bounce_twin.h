// The CPU twin of a bounce of light, one vertex and term at a time: naive on purpose.
#pragma once

#include "engine/render/appearance.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Returns the coefficients, kBounceCoefficients, of what BounceGather gives a vertex's term in a set, before
// any are dropped: a sum over the centers of 6 · size² texels of directions, of the rows of all three corners
// of what each meets. `from`: as for BounceGather::gather(). `gains`: sourceGains(). `tracer`: of the asset's
// partMeshes().
std::vector<vec3> bouncedVector(const Asset& asset, const Appearance& bound,
                                std::span<const std::vector<vec3>> gains, const RayTracer& tracer,
                                std::span<const SparseTransport> from, size_t part, uint32_t vertex,
                                size_t set, int term, int size);

} // namespace relume

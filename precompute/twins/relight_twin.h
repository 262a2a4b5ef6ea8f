// The CPU twin of relighting, for every layout of transport: naive on purpose.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/transport.h"

namespace relume {

// Integer sums Σ c·l of every row, 32-bit.
std::vector<ivec3> relightSums(const SparseTransport& transport, const LightVector& light);

// The tuple of every row, bit for bit that of the relighter (engine/render/relighter.h).
std::vector<vec3> relight(const Transport& transport, const LightVector& light);

} // namespace relume

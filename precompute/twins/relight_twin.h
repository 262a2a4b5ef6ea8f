// The CPU twin of relighting, for every layout; deliberately naive.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/transport.h"

namespace relume {

// Returns the 32-bit integer sums Σ c·l of every row.
std::vector<ivec3> relightSums(const SparseTransport& transport, const LightVector& light);

// Returns the tuple of every row, bit for bit as the relighter (engine/render/relighter.h).
std::vector<vec3> relight(const Transport& transport, const LightVector& light);

} // namespace relume

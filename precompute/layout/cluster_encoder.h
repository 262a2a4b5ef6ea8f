// Transport in rows as columns that the vertices of a cluster share.
#pragma once

#include "engine/transport/clustered_transport.h"
#include "engine/transport/sparse_transport.h"

#include <span>

namespace relume {

// Squares of what every column of a cluster holds that keepColumns() could keep, in no order: over its
// vertices, times the light's spectrum, in units of `unit`.
std::vector<float> columnEnergies(const SparseTransport& rows, size_t cluster,
                                  std::span<const float> spectrum, float unit);

struct KeptColumns {
    ClusteredTransport transport; // of this cluster alone
    double error = 0;             // sum of the squares of the columns that were dropped
};

// Keeps columns of at least `threshold` (of the same measure), the strongest kMostClusterColumns at most.
KeptColumns keepColumns(const SparseTransport& rows, size_t cluster, std::span<const float> spectrum,
                        float unit, float threshold);

// Adds the clusters of `more` behind those of `all`, of as many terms, whose last is full.
void append(ClusteredTransport& all, const ClusteredTransport& more);

} // namespace relume

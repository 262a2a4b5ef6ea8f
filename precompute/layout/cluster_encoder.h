// Transport in rows as columns that the vertices of a cluster share.
#pragma once

#include "engine/transport/clustered_transport.h"
#include "engine/transport/sparse_transport.h"

#include <span>

namespace relume {

// Squares of what every column holds that encodeClusters() could keep, in no order: over the cluster's
// vertices, times the light's spectrum, in units of `unit`.
std::vector<float> columnEnergies(const SparseTransport& rows, std::span<const float> spectrum, float unit);

struct EncodedClusters {
    ClusteredTransport transport;
    double error = 0; // sum of the squares of the columns that were dropped
};

// Keeps columns of at least `threshold` (of the same measure); of a cluster the strongest
// kMostClusterColumns at most.
EncodedClusters encodeClusters(const SparseTransport& rows, std::span<const float> spectrum, float unit,
                               float threshold);

} // namespace relume

// Runs of clustered transport as bytes that compress well: the TRCL chunks of docs/asset_format.md.
#pragma once

#include "engine/transport/clustered_transport.h"

#include <cstddef>
#include <span>
#include <string>

namespace relume {

// Bytes of a run, which is one cluster, before compression.
constexpr size_t kClusterRunHeaderBytes = 12, kClusterGroupBytes = 2, kClusterRowBytes = 4,
                 kClusterColumnBytes = 2 + 4 * kClusterVertices;

// Most columns that a cluster may have in all its terms together, so that a run stays within a chunk.
constexpr uint32_t kMostClusterColumns = 48 * 1024;

// Wants valid transport (asset_check.h). Cluster 0 of `transport` is cluster `offset` of its set.
std::vector<std::byte> encodeCluster(const ClusteredTransport& transport, uint32_t cluster,
                                     uint32_t offset = 0);

// Appends a cluster to `transport`, whose vertices and terms are set, whose columnStarts hold one more than
// the groups read so far, and whose cluster 0 is cluster `offset` of its set. Columns must have indices below
// `coefficients`, and must not pass `columnLimit` in all. `where` names the chunk in errors. Throws Error.
void decodeCluster(std::span<const std::byte> raw, uint32_t coefficients, size_t columnLimit,
                   const std::string& where, ClusteredTransport& transport, uint32_t offset = 0);

} // namespace relume

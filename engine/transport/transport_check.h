// What must hold of transport, whether it is about to be written or has just been read.
#pragma once

#include "engine/transport/transport.h"

#include <string>

namespace relume {

// Rows that rise, of at most `longestRow` entries with indices below `coefficients`. `where` stands for the
// transport in errors. Throws Error.
void checkTransport(const SparseTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where);

// What the weights of all clusters are amounts of. Throws Error.
void checkKinds(const BasisTransport& transport, const std::string& where);

// One cluster of so many vertices. Throws Error.
void checkCluster(const BasisCluster& cluster, size_t vertices, size_t kinds, uint32_t coefficients,
                  const std::string& where);

// All of them, and the kinds. Throws Error.
void checkTransport(const BasisTransport& transport, uint32_t coefficients, const std::string& where);

} // namespace relume

// Clusters of bases as bytes that compress well: the TRBS chunks of docs/asset_format.md.
#pragma once

#include "engine/transport/basis_transport.h"

#include <cstddef>
#include <span>
#include <string>

namespace relume {

// Most bytes of a cluster before compression.
constexpr size_t largestBasisChunk(size_t terms) {
    const size_t kinds = 3 * terms, scales = kinds * kMostBasisComponents;
    return 16 + kinds * sizeof(uint16_t) + scales * sizeof(float) + kMostBasisColumns * sizeof(uint16_t) +
           kMostBasisColumns * kMostBasisComponents + scales * kBasisVertices;
}

// Wants a valid cluster (transport_check.h), the `number`-th of its set.
std::vector<std::byte> encodeBasisCluster(const BasisTransport& transport, size_t number);

// Appends the next cluster to `transport`, whose vertices, terms and kinds are set. Columns must have indices
// below `coefficients`. `where` names the chunk in errors. Throws Error.
void decodeBasisCluster(std::span<const std::byte> raw, uint32_t coefficients, const std::string& where,
                        BasisTransport& transport);

} // namespace relume

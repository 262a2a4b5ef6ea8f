// Clusters of bases as bytes that compress well: the TRBS chunks of docs/asset_format.md.
#pragma once

#include "engine/transport/basis_transport.h"

#include <cstddef>
#include <span>
#include <string>

namespace relume {

constexpr size_t kBasisHeaderBytes = 16;

// Most bytes of a cluster before compression.
constexpr size_t largestBasisChunk(size_t terms) {
    const size_t kinds = 3 * terms, scales = kinds * kMostBasisComponents;
    return kBasisHeaderBytes + kinds * sizeof(uint16_t) + scales * sizeof(float) +
           kMostBasisColumns * sizeof(uint16_t) + kMostBasisColumns * kMostBasisComponents +
           scales * kBasisVertices;
}

// Wants a valid cluster (transport_check.h) of so many vertices, the `number`-th of its set.
std::vector<std::byte> encodeBasisCluster(const BasisCluster& cluster, uint32_t number, uint32_t vertices);

// How many columns a chunk says that it has. Throws Error for one that is too short to say.
uint32_t basisColumns(std::span<const std::byte> raw, const std::string& where);

// The same cluster back, which must be the `number`-th, of so many vertices and kinds. Columns must have
// indices below `coefficients`. `where` names the chunk in errors. Throws Error.
BasisCluster decodeBasisCluster(std::span<const std::byte> raw, uint32_t number, uint32_t vertices,
                                size_t kinds, uint32_t coefficients, const std::string& where);

} // namespace relume

// Coding of clusters of bases as bytes that compress well: the TRBS chunks of docs/asset_format.md.
#pragma once

#include "engine/chunk/block_chunk.h"
#include "engine/transport/bases/basis_transport.h"

namespace relume {

constexpr size_t kBasisHeaderBytes = 16;

// Returns the most bytes that a cluster of `terms` terms can have before compression.
constexpr size_t largestBasisChunk(size_t terms) {
    const size_t kinds = 3 * terms, scales = kinds * kMostBasisComponents;
    return kBasisHeaderBytes + kinds * sizeof(uint16_t) + scales * sizeof(float) +
           kMostBasisColumns * sizeof(uint16_t) + kMostBasisColumns * kMostBasisComponents +
           scales * kBasisVertices;
}

// Encodes a valid cluster of `vertices` vertices, number `number` of its set.
std::vector<std::byte> encodeBasisCluster(const BasisCluster& cluster, uint32_t number, uint32_t vertices);

// Decodes what encodeBasisCluster() made. Throws Error unless it is valid and has this number, so many
// vertices and kinds, and column indices below `coefficients`. `where` names the chunk in errors.
BasisCluster decodeBasisCluster(std::span<const std::byte> raw, uint32_t number, uint32_t vertices,
                                size_t kinds, uint32_t coefficients, const std::string& where);

// The functions that layout_chunks.h lists; checkLayout() is in basis_transport.h.
inline uint32_t blockVertices(const BasisTransport&, int, int) { return kBasisVertices; }
void addTransport(ChunkWriter& file, uint32_t owner, const BasisTransport& transport, uint32_t block);
void readTransport(const ChunkFile& file, uint32_t owner, uint64_t columns, uint32_t coefficients,
                   BasisTransport& transport);
ChunkSizes chunkSizes(const BasisTransport& layout, uint32_t vertices, int coefficients);
uint64_t memoryBytes(const BasisTransport& layout, uint32_t vertices, uint64_t rawSize);
uint64_t entriesOf(const BasisTransport& layout, uint32_t vertices, uint64_t rawSize, const LoadChunk& load);
void checkChunk(const BasisTransport& layout, const BlockPlace& place, std::span<const std::byte> raw,
                const RowLimits& limits, const std::string& where);

} // namespace relume

// Coding of runs of transport rows as bytes that compress well: the TRAN chunks of docs/asset_format.md.
#pragma once

#include "engine/chunk/block_chunk.h"
#include "engine/scene/factored_brdf.h"
#include "engine/transport/rows/sparse_transport.h"

namespace relume {

// The most entries and rows of a run that is written.
constexpr size_t kRunEntries = size_t(1) << 20;
constexpr uint32_t kMostBlockVertices = 64;
constexpr size_t kRunRows = kMostBlockVertices * size_t(kMostTerms);

// Returns the vertices of a block, which is baked, stored in a checkpoint and written as one run: the largest
// power of two up to kMostBlockVertices for which `terms` rows of `coefficients` entries each stay within
// kRunEntries. A part's last block may be shorter. It depends on nothing else, so that files do not depend on
// the device or on interruptions.
uint32_t blockVertices(int coefficients, int terms);
inline uint32_t blockVertices(const SparseTransport&, int coefficients, int terms) {
    return blockVertices(coefficients, terms);
}

// Bytes of a run before compression: of its header, and per row and entry.
constexpr size_t kRunHeaderBytes = 12, kRunRowBytes = 6, kRunEntryBytes = 6;

// The vertices [first, end).
struct VertexRun {
    uint32_t first, end;
};

// Encodes a run of valid rows (checkTransport()). Vertex 0 of `transport` is vertex `offset` of its set.
std::vector<std::byte> encodeRun(const SparseTransport& transport, VertexRun run, uint32_t offset = 0);

// Appends a run to `transport`, whose vertices and terms are set and whose vertex 0 is vertex `offset` of its
// set; rowStarts has one more element than rows read so far. Throws Error if the run does not follow these,
// if indices are not below `coefficients`, or if `transport` would have more than `entryLimit` entries.
// `where` names the chunk in errors.
void decodeRun(std::span<const std::byte> raw, uint32_t coefficients, size_t entryLimit,
               const std::string& where, SparseTransport& transport, uint32_t offset = 0);

// Map a packed 11/11/10 word to the word that is stored, and back: byte 0 holds green's low bits, byte 1
// those of red - green, byte 2 those of blue - green / 2, byte 3 the high bits (3, 3, 2). Each number is
// zigzag-coded, so that small ones of either sign have few bits. For a gray material bytes 1 and 2 are nearly
// all zero.
uint32_t decorrelate(uint32_t packed);
uint32_t correlate(uint32_t stored);

// The functions that layout_chunks.h lists.
void addTransport(ChunkWriter& file, uint32_t owner, const SparseTransport& transport, uint32_t block);
void readTransport(const ChunkFile& file, uint32_t owner, uint64_t entries, uint32_t coefficients,
                   SparseTransport& transport);
ChunkSizes chunkSizes(const SparseTransport& layout, uint32_t vertices, int coefficients);
uint64_t memoryBytes(const SparseTransport& layout, uint32_t vertices, uint64_t rawSize);
uint64_t entriesOf(const SparseTransport& layout, uint32_t vertices, uint64_t rawSize, const LoadChunk& load);
void checkChunk(const SparseTransport& layout, const BlockPlace& place, std::span<const std::byte> raw,
                const RowLimits& limits, const std::string& where);
inline void checkLayout(const SparseTransport&, const std::string&) {} // rows have no other data

} // namespace relume

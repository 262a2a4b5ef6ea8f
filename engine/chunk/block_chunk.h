// What layouts of transport say and are told of the chunk that holds a block of vertices.
#pragma once

#include "engine/chunk/chunk_file.h"

namespace relume {

constexpr int kLargestTerms = 32; // of a set

// A block in its set: its vertices from `first` on, and the run of its chunk.
struct BlockPlace {
    uint32_t first, vertices, run;
};

// Bytes that a chunk can have before compression.
struct ChunkSizes {
    uint64_t least, most, step;
};

// What indices of coefficients are below, and most entries of a row.
struct RowLimits {
    uint32_t coefficients;
    uint64_t longestRow;
};

// Gives the bytes of a chunk before compression.
using LoadChunk = std::function<std::vector<std::byte>()>;

} // namespace relume

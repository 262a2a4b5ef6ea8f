// Types with which layouts of transport describe and check the chunk of a block of vertices.
#pragma once

#include "engine/chunk/chunk_file.h"

namespace relume {

// The place of a block in its set: its range of vertices and the run of its chunk.
struct BlockPlace {
    uint32_t first, vertices, run;
};

// The sizes in bytes that a chunk can have before compression: `least` to `most` in steps of `step`.
struct ChunkSizes {
    uint64_t least, most, step;
};

// Limits against which rows are checked.
struct RowLimits {
    uint32_t coefficients; // every index is below this
    uint64_t longestRow;   // most entries in a row
};

// Returns the bytes of a chunk before compression.
using LoadChunk = std::function<std::vector<std::byte>()>;

} // namespace relume

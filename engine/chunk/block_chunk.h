// Helpers shared by the layouts of transport, which describe, code and check the chunk of a block of
// vertices.
#pragma once

#include "engine/base/error.h"
#include "engine/chunk/chunk_file.h"

#include <cmath>
#include <cstdint>
#include <fmt/core.h>
#include <span>
#include <string>
#include <vector>

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

// Throw Error, in which `where` names the place, if data are not as they must be.
inline void expect(bool holds, const std::string& where, const char* what) {
    if (!holds) throw Error(fmt::format("{}: expected {}", where, what));
}

inline void expectCount(size_t count, size_t expected, const std::string& where, const char* what) {
    if (count != expected)
        throw Error(fmt::format("{}: expected {} {}, found {}", where, expected, what, count));
}

inline bool isMagnitude(float value) { return std::isfinite(value) && value >= 0; }

// Rising indices of coefficients are stored as the gaps between them.

// Calls take(gap) for each index, with the number of indices skipped before it.
template <typename Take>
void forEachGap(std::span<const uint16_t> indices, const Take& take) {
    uint32_t next = 0; // the smallest index that may come
    for (const uint16_t index : indices) {
        take(uint16_t(index - next));
        next = index + 1u;
    }
}

// Appends to `indices` those that have these gaps. Throws Error if one is not below `coefficients`.
inline void decodeIndices(std::span<const uint16_t> gaps, uint32_t coefficients, const std::string& where,
                          std::vector<uint16_t>& indices) {
    uint32_t next = 0;
    for (const uint16_t gap : gaps) {
        const uint32_t index = next + gap;
        if (index >= coefficients)
            throw Error(fmt::format("{}: expected indices below {}, found {}", where, coefficients, index));
        indices.push_back(uint16_t(index));
        next = index + 1;
    }
}

// Throws Error if indices do not rise or one is not below `coefficients`; where() returns their location.
template <typename Where>
void checkIndices(std::span<const uint16_t> indices, uint32_t coefficients, const Where& where) {
    uint32_t next = 0;
    for (const uint32_t index : indices) {
        if (index < next || index >= coefficients)
            throw Error(
                fmt::format("{}: expected rising indices below {}, found {}", where(), coefficients, index));
        next = index + 1;
    }
}

} // namespace relume

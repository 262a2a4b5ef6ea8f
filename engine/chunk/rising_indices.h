// Rising indices of coefficients, and their form in a file: the gaps between them.
#pragma once

#include "engine/base/error.h"

#include <cstdint>
#include <fmt/format.h>
#include <span>
#include <string>
#include <vector>

namespace relume {

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

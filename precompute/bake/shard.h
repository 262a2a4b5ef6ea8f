// The division of a bake's blocks among machines.
#pragma once

#include <cstdint>
#include <string>

namespace relume {

constexpr uint32_t kMostShards = 1000000;

// The blocks index, index + count, index + 2 count, ….
struct Shard {
    uint32_t index = 0, count = 1;

    bool has(uint32_t block) const { return block % count == index; }
    // Returns how many of the first `blocks` blocks it has; none if there are more shards than blocks.
    uint32_t size(uint32_t blocks) const { return blocks / count + (index < blocks % count ? 1 : 0); }

    bool operator==(const Shard&) const = default;
};

// Parses "I/N", where I counts from 0. Throws UsageError.
Shard parseShard(const std::string& text);

} // namespace relume

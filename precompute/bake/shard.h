// A bake's blocks dealt out to several machines.
#pragma once

#include <cstdint>
#include <string>

namespace relume {

constexpr uint32_t kMostShards = 1000000;

// Blocks index, index + count, index + 2 count, ….
struct Shard {
    uint32_t index = 0, count = 1;

    bool has(uint32_t block) const { return block % count == index; }
    // How many of the first `blocks` blocks it has: none, where there are more shards than blocks.
    uint32_t size(uint32_t blocks) const { return blocks / count + (index < blocks % count ? 1 : 0); }

    bool operator==(const Shard&) const = default;
};

// From "I/N", I from 0. Throws UsageError.
Shard parseShard(const std::string& text);

} // namespace relume

#include "precompute/bake/shard.h"

#include "engine/base/error.h"

#include <charconv>
#include <fmt/core.h>

namespace relume {

Shard parseShard(const std::string& text) {
    Shard shard;
    const char* const end = text.data() + text.size();
    const auto index = std::from_chars(text.data(), end, shard.index);
    const bool hasSlash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
    const auto count = hasSlash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
    if (!hasSlash || count.ec != std::errc() || count.ptr != end || shard.count < 1 ||
        shard.count > kMostShards)
        throw UsageError(
            fmt::format("--shard: expected I/N, as 0/4 for the first of 4 shards, with N from 1 to {}; found "
                        "\"{}\"",
                        kMostShards, text));
    if (shard.index >= shard.count)
        throw UsageError(fmt::format(
            "--shard: shards are counted from 0, as ranks and completion indices are: the first of "
            "{0} is 0/{0}, the last {1}/{0}; found \"{2}\"",
            shard.count, shard.count - 1, text));
    return shard;
}

} // namespace relume

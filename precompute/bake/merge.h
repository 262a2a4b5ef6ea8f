// The shards of a bake joined.
#pragma once

#include "precompute/bake/shard_file.h"

namespace relume {

// Writes the bytes of a bake that was not cut into shards, whatever the order of these. Holds the meshes, the
// materials and one chunk of transport. Throws Error, maybe after output began: for shards of different
// bakes, saying how they differ; for missing and doubled ones; for whatever does not check out. Gives its
// vertices.
uint64_t mergeShards(std::span<const ShardFile> shards, const ChunkWriter::Output& output);

} // namespace relume

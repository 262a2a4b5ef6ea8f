// Joins the shards of a bake.
#pragma once

#include "precompute/bake/shard_file.h"

namespace relume {

// Writes the asset, byte for byte as an unsharded bake would; the order of `shards` does not matter. Holds
// the meshes, the materials and one chunk of transport in memory. Returns the number of vertices. Throws
// Error, maybe after output began, for shards of different bakes (saying how they differ), missing or
// duplicate shards, and invalid content.
uint64_t mergeShards(std::span<const ShardFile> shards, const ChunkWriter::Output& output);

} // namespace relume

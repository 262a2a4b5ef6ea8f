// The chunks of an asset's file, for writers and readers that do not hold its transport in memory. asset.h
// has functions for whole assets.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"
#include "engine/transport/asset_meta.h"

#include <functional>

namespace relume {

// Adds all chunks of a valid asset in file order. Its transport may be missing: `addTransport(set)` must add
// that of a set, counted over all parts, as runs of blockVertices(asset) vertices with `setEntries[set]`
// entries in all (entriesOf() in transport.h). With a `visibilityKey` the caller adds the chunks of
// visibility afterwards.
void addChunks(ChunkWriter& file, const Asset& asset, std::span<const uint64_t> setEntries,
               const std::function<void(uint32_t set)>& addTransport, const std::string& visibilityKey = {});

// A whole bake, or what one of several machines baked of it: docs/asset_format.md.
enum class AssetFileKind { Bake, Shard };

// Reads chunk META of a file of this kind. Throws Error, also if a required chunk is unknown.
AssetMeta readMeta(const ChunkFile& file, AssetFileKind kind);

// Fills all arrays except transport. Their contents remain to be checked, by checkSkeleton(). Throws Error.
void readArrays(const ChunkFile& file, AssetMeta& meta);

} // namespace relume

// The chunks of an asset's file, for writers and readers that do not hold its transport: asset.h has the
// rest.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"
#include "engine/transport/asset_meta.h"

#include <functional>

namespace relume {

// Adds all chunks of a valid asset in file order. Its transport may be missing: `addTransport(set)` adds that
// of a set, counted over all parts, as runs of blockVertices(asset) vertices with `setEntries[set]` entries
// (entriesOf() of transport.h) in all. With a `visibilityKey` the caller adds the chunks of visibility behind
// these.
void addChunks(ChunkWriter& file, const Asset& asset, std::span<const uint64_t> setEntries,
               const std::function<void(uint32_t set)>& addTransport, const std::string& visibilityKey = {});

// Whole, or what one machine of several baked of it: docs/asset_format.md.
enum class AssetFileKind { Bake, Shard };

// The chunk META of a file of this kind, all required chunks of which are known. Throws Error.
AssetMeta readMeta(const ChunkFile& file, AssetFileKind kind);

// Fills all arrays but the transport. What the numbers in them are is for checkSkeleton() to say. Throws
// Error.
void readArrays(const ChunkFile& file, AssetMeta& meta);

} // namespace relume

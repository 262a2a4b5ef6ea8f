// The chunks of an asset's file, for writers that do not hold its transport: asset.h has the rest.
#pragma once

#include "engine/transport/asset.h"
#include "engine/transport/chunk_file.h"

#include <functional>

namespace relume {

// Adds all chunks of a valid asset in file order. Its transport may be missing: `addTransport(set)` adds that
// of a set, counted over all parts, as runs of blockVertices(asset) vertices with `setEntries[set]` entries
// in all.
void addChunks(ChunkWriter& file, const Asset& asset, std::span<const uint64_t> setEntries,
               const std::function<void(uint32_t set)>& addTransport);

} // namespace relume

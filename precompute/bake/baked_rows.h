// What baking some vertices of a part gives.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"
#include "precompute/bake/transport_pass.h"

#include <vector>

namespace relume {

// Of one set: rows, and what each lost.
struct BakedRows {
    SparseTransport transport; // its first vertex is the first that was baked
    std::vector<TransportLosses> losses;

    explicit BakedRows(uint32_t terms);
    // Of vertices [first, end) alone.
    BakedRows vertices(uint32_t first, uint32_t end) const;
    // Adds those vertices behind its own.
    void append(const BakedRows& more);
};

// A block: its rows, a BakedRows per set of its part, and its visibility.
struct BakedBlock {
    std::vector<BakedRows> sets;
    std::vector<uint32_t> visibility;          // bits, vertex after vertex, where the plan keeps them
    std::vector<StoredChunk> packedVisibility; // in their place, once packed (stored_blocks.h)

    // Summed set after set, row by row: the same however it was baked.
    TransportLosses losses() const;
};

// `losses`: summed over the asset's blocks in their order.
void setErrors(const TransportLosses& losses, Asset& asset);

} // namespace relume

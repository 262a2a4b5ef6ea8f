// Baked rows of vertices, as they come from the device.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"
#include "precompute/bake/transport_pass.h"

#include <vector>

namespace relume {

// Rows of one set, and the losses of each row.
struct BakedRows {
    SparseTransport transport; // counted from the first baked vertex
    std::vector<TransportLosses> losses;

    explicit BakedRows(uint32_t terms);
    // Returns a copy of vertices [first, end).
    BakedRows vertices(uint32_t first, uint32_t end) const;
    // Appends the vertices of `more`.
    void append(const BakedRows& more);
};

// Returns rows of no vertices for each set of a part.
std::vector<BakedRows> emptyBakedRows(const AssetPart& part);

// A baked block: rows per set of its part, and visibility.
struct BakedBlock {
    std::vector<BakedRows> sets;
    std::vector<uint32_t> visibility;          // bits, vertex by vertex, if the plan keeps them
    std::vector<StoredChunk> packedVisibility; // replaces the bits once packed (stored_blocks.h)

    // Returns the sum over sets and rows in a fixed order, so that the bits do not depend on how it was
    // baked.
    TransportLosses losses() const;
};

// Sets the asset's measured errors from `losses`, summed over its blocks in order.
void setErrors(const TransportLosses& losses, Asset& asset);

} // namespace relume

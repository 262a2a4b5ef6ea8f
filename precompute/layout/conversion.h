// An asset's transport from one layout to another.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <functional>

namespace relume {

struct Conversion {
    uint64_t bytesBefore = 0, bytesAfter = 0; // of transport in memory
    // As in LayoutOptions, of what was lost against the transport before; none where rows were made.
    std::optional<double> error;
};

uint64_t verticesOf(const Asset& asset);

// The asset's record adds what was lost now to what it says was lost before, an estimate; rows that are made
// of another layout keep the record.
// By way of rows of at most asset.coefficients entries, or `coefficients` if that is less. Calls
// progress(vertices of all sets that are done, of how many) from the calling thread, and does nothing more
// once that throws. The same asset and options give the same bytes.
Conversion convertLayout(Asset& asset, const LayoutOptions& options,
                         const std::function<void(uint64_t done, uint64_t total)>& progress = {},
                         std::optional<int> coefficients = {});

} // namespace relume

// Converts an asset's transport from one layout to another.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <functional>

namespace relume {

struct Conversion {
    uint64_t bytesBefore = 0, bytesAfter = 0; // of transport in memory
    // Error as in LayoutOptions, relative to the rows that bases were made from; none if the result is rows.
    std::optional<double> error;
};

// Converts by way of rows of at most asset.coefficients entries, or `coefficients` if that is less; bases of
// one term become bases by way of rowEntries(). The asset's layout record adds the new error to the one
// recorded before, an estimate; rows made from another layout keep the record. Calls progress(vertices done,
// total) over the vertices of all sets from the calling thread; what it throws ends the conversion. The same
// asset and options give the same bytes.
Conversion convertLayout(Asset& asset, const LayoutOptions& options,
                         const std::function<void(uint64_t done, uint64_t total)>& progress = {},
                         std::optional<int> coefficients = {});

} // namespace relume

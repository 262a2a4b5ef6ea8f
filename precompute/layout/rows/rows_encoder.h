// Encodes rows: stores them as baked, and makes them from other layouts.
#pragma once

#include "precompute/transport/layout_work.h"

namespace relume {

// Converts the sets' transport from any layout to rows of at most asset.coefficients entries; or, if they are
// to become bases again, of rowEntries().
void makeRows(std::span<MaterialSet* const> sets, const Asset& asset, bool becomeBases,
              ConversionPasses& passes);

// The functions that layouts.h requires of a layout.
inline void prepareLayout(SparseTransport&, const FactoredBrdf&, bool) {}
EncodedBlock encodeBlock(const SparseTransport& layout, const SparseTransport& rows,
                         const BlockCoding& coding);
inline double findLambda(const SparseTransport&, std::span<const SetSample>, int, const LayoutTarget&) {
    return 0;
}
inline double convertRows(const SparseTransport&, const RowSource&, const LayoutTarget&, ConversionPasses&) {
    return 0;
}

} // namespace relume

// Rows as they are baked, and of other layouts.
#pragma once

#include "precompute/transport/layout_work.h"

namespace relume {

// Makes rows of at most asset.coefficients entries of transport in any layout.
void makeRows(std::span<MaterialSet* const> sets, const Asset& asset, ConversionPasses& passes);

// What layouts.h wants of a layout.
inline void prepareLayout(SparseTransport&, const FactoredBrdf&, bool) {}
EncodedBlock encodeBlock(const SparseTransport& layout, const SparseTransport& rows,
                         const BlockCoding& coding);
inline double findPrice(const SparseTransport&, std::span<const SetSample>, int, const LayoutTarget&) {
    return 0;
}
inline double convertRows(const SparseTransport&, const RowSource&, const LayoutTarget&, ConversionPasses&) {
    return 0;
}

} // namespace relume

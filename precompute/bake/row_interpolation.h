// Interpolates rows of vertices from rows of coarse ones.
#pragma once

#include "precompute/bake/baked_rows.h"
#include "precompute/bake/coarse_neighbors.h"
#include "precompute/transport/row_sum.h"

namespace relume {

// Interpolates the rows of one set.
class RowInterpolator {
  public:
    // Keeps a reference to `coarse`. Rows have `coefficients` coefficients, of which the `kept` largest are
    // stored.
    RowInterpolator(const BakedRows& coarse, int coefficients, int kept);

    // Appends a vertex's rows: the weighted sums of its neighbors' rows, packed by packLargest(); those of a
    // single neighbor are copied. Losses are the weighted sums of the neighbors' losses.
    void append(std::span<const CoarseNeighbor> neighbors, BakedRows& rows);

  private:
    void appendSum(std::span<const CoarseNeighbor> neighbors, uint32_t term, BakedRows& rows);

    const BakedRows& mCoarse;
    int mKept;
    RowSum mSum; // empty between calls
};

} // namespace relume

// Rows of vertices that are not baked yet, from rows of some that are.
#pragma once

#include "precompute/bake/baked_rows.h"
#include "precompute/bake/coarse_neighbors.h"
#include "precompute/transport/row_sum.h"

namespace relume {

// One set's.
class RowInterpolator {
  public:
    // `coarse` outlives it. Rows keep the `kept` largest of `coefficients` coefficients.
    RowInterpolator(const BakedRows& coarse, int coefficients, int kept);

    // Appends a vertex's rows: sums of its neighbors' times their shares, packed as any (packLargest); those
    // of a single neighbor as they are. What they lost is taken to be what the neighbors did.
    void append(std::span<const CoarseNeighbor> neighbors, BakedRows& rows);

  private:
    void appendSum(std::span<const CoarseNeighbor> neighbors, uint32_t term, BakedRows& rows);

    const BakedRows& mCoarse;
    int mKept;
    RowSum mSum; // empty between calls
};

} // namespace relume

// Rows of vertices that are not baked yet, from rows of some that are.
#pragma once

#include "precompute/bake/baked_rows.h"
#include "precompute/bake/coarse_neighbours.h"
#include "precompute/transport/row_sum.h"

namespace relume {

// One set's.
class RowInterpolator {
  public:
    // `coarse` outlives it. Rows keep the `kept` largest of `coefficients` coefficients.
    RowInterpolator(const BakedRows& coarse, int coefficients, int kept);

    // Appends a vertex's rows: sums of its neighbours' times their shares, packed as any (packLargest); those
    // of a single neighbour as they are. What they lost is taken to be what the neighbours did.
    void append(std::span<const CoarseNeighbour> neighbours, BakedRows& rows);

  private:
    void appendSum(std::span<const CoarseNeighbour> neighbours, uint32_t term, BakedRows& rows);

    const BakedRows& mCoarse;
    int mKept;
    RowSum mSum; // empty between calls
};

} // namespace relume

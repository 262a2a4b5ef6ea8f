// Coarse rows, from which previews interpolate the vertices that are not baked yet.
#pragma once

#include "precompute/bake/baked_rows.h"
#include "precompute/bake/block_baker.h"
#include "precompute/bake/coarse_neighbors.h"
#include "precompute/bake/stored_blocks.h"
#include "precompute/transport/row_sum.h"

#include <functional>

namespace relume {

// Interpolates the rows of one set from those of coarse vertices.
class RowInterpolator {
  public:
    // Keeps a reference to `coarse`. Rows have `coefficients` coefficients, of which the `kept` largest are
    // stored.
    RowInterpolator(const BakedRows& coarse, int coefficients, int kept);

    // Appends a vertex's rows: the weighted sums of its neighbors' rows, packed by packLargest(). Losses are
    // the weighted sums of the neighbors' losses.
    void append(std::span<const CoarseNeighbor> neighbors, BakedRows& rows);

  private:
    void appendSum(std::span<const CoarseNeighbor> neighbors, uint32_t term, BakedRows& rows);

    const BakedRows& mCoarse;
    int mKept;
    RowSum mSum; // empty between calls
};

// Rows of direct light for one vertex in twelve, or fewer so that they take at most 256 MiB. What is
// interpolated from them depends on the plan alone.
class CoarseRows {
  public:
    // Bakes coarse rows for the parts that contain `blocks`. Throws BakeStopped and Error; `plan`, whose
    // occluder is moved out meanwhile, is then unusable.
    CoarseRows(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> blocks,
               const BakeLimits& limits, BakeObserver& observer);

    // Interpolates `blocks` and passes each to `store`, encoded in the plan's layout, with bounced light if
    // the plan has it. Throws BakeStopped, and what `store` throws.
    void interpolate(const BakePlan& plan, std::span<const uint32_t> blocks,
                     const std::function<void(uint32_t block, StoredBlock stored)>& store,
                     BakeObserver& observer) const;

    // Returns an upper bound on the bytes of interpolated rows for all vertices of a plan.
    static uint64_t interpolatedBytes(const BakePlan& plan);

  private:
    // The coarse vertices of a part; none if no block of it is wanted.
    struct Part {
        std::vector<uint32_t> vertices;
        float spacing = 1;
    };

    std::vector<Part> mParts;
    std::vector<BakedRows> mRows; // per set, counted over all parts
};

} // namespace relume

// Previews: whole assets that are written while a bake is running.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/checkpoint.h"
#include "precompute/bake/coarse_rows.h"

#include <functional>

namespace relume {

// Writes an asset made of these blocks, which are all of the plan's.
using PreviewWriter = std::function<void(const StoredBlocks& blocks)>;

// Divides `blocks` into at most four portions to be baked one after the other, each spread evenly over the
// surface.
std::vector<std::vector<uint32_t>> previewPortions(const BakePlan& plan, std::span<const uint32_t> blocks);

// Makes the previews of a bake, from the blocks in `checkpoint` and, for the others, blocks interpolated from
// coarse rows, which are kept in `interpolated`. Keeps references to all arguments, which must outlive it.
class Previews {
  public:
    // Bakes coarse rows if `interpolated` lacks any of the `missing` blocks. Throws as CoarseRows.
    Previews(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> missing,
             const BakeLimits& limits, const Checkpoint& checkpoint, Checkpoint& interpolated,
             PreviewWriter write, BakeObserver& observer);

    // Writes a first preview before bounced light and the layout's scale are known: direct light, in rows.
    // Does nothing if blocks are baked already, or if it would take more than 512 MiB.
    void writeDraft();

    // Bakes `missing`, the blocks that the checkpoint lacks, into `sink`, which appends them to it. Writes a
    // preview before that, and after every portion but the last unless writing would take much of the time.
    // `kept` is as for bakeBlocks(); the plan must not keep visibility. Throws BakeStopped and Error.
    void bake(std::span<const uint32_t> missing, const BakeLimits& limits, BakeSink& sink,
              KeptVisibility* kept, BakeTimes& times);

  private:
    const vk::Device& mDevice;
    BakePlan& mPlan;
    const Checkpoint& mCheckpoint;
    Checkpoint& mInterpolated;
    PreviewWriter mWrite;
    BakeObserver& mObserver;
    std::optional<CoarseRows> mCoarse; // none if all interpolated blocks are stored
    double mSeconds = 0;               // spent on previews
};

} // namespace relume

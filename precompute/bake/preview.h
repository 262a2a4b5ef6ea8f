// Images of the whole while it is being baked.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/checkpoint.h"
#include "precompute/bake/coarse_rows.h"

#include <functional>

namespace relume {

// Writes the asset of these blocks, all of the plan's.
using PreviewWriter = std::function<void(const StoredBlocks& blocks)>;

// The blocks in portions, to be baked one after the other, each spread evenly over the surfaces; at most
// four.
std::vector<std::vector<uint32_t>> previewPortions(const BakePlan& plan, std::span<const uint32_t> blocks);

// The previews of a bake, which `write` writes: of blocks that `checkpoint` has, and others interpolated from
// coarse rows, which `interpolated` keeps. All that is given must outlive it.
class Previews {
  public:
    // Bakes the coarse rows if `interpolated` lacks any of the `missing` blocks. Throws as CoarseRows.
    Previews(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> missing,
             const BakeLimits& limits, const Checkpoint& checkpoint, Checkpoint& interpolated,
             PreviewWriter write, BakeObserver& observer);

    // Writes a preview before bounced light and the layout's scale are known: of direct light, in rows. It is
    // left out where blocks are baked already, and where it would take more than 512 MiB.
    void writeDraft();

    // Bakes `missing`, the blocks that the checkpoint lacks, into `sink`, which puts them there. Before that,
    // and after every portion but the last as far as writing takes little of the time, it writes a preview.
    // `kept` as for bakeBlocks(), not for a plan that keeps visibility. Throws BakeStopped, Error.
    void bake(std::span<const uint32_t> missing, const BakeLimits& limits, BakeSink& sink,
              KeptVisibility* kept, BakeTimes& times);

  private:
    const vk::Device& mDevice;
    BakePlan& mPlan;
    const Checkpoint& mCheckpoint;
    Checkpoint& mInterpolated;
    PreviewWriter mWrite;
    BakeObserver& mObserver;
    std::optional<CoarseRows> mCoarse; // none: all that is interpolated is kept
    double mSeconds = 0;               // all that previews took
};

} // namespace relume

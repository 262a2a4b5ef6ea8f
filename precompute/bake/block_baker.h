// Bakes blocks of a plan, one after another.
#pragma once

#include "engine/transport/kept_visibility.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"
#include "precompute/bake/batch_plan.h"

#include <span>

namespace relume {

// Where a bake's time went.
struct BakeTimes {
    double total = 0; // wall-clock seconds, all told
    double factorisation = 0;
    double occluder = 0;  // merging and simplifying
    double bounces = 0;   // gathering bounced light, on the host
    double previews = 0;  // making and writing them
    vk::PassTimes device; // device seconds by pass
    uint32_t batch = 0;   // most points of a submission
};

// Takes blocks as they are finished.
class BakeSink {
  public:
    virtual ~BakeSink() = default;
    virtual void take(uint32_t block, BakedBlock baked) = 0;
    // Returns once all that was taken is where it goes.
    virtual void finish() {}
};

// Bakes the blocks of these numbers in their order; those of a part had best be together. Progress is told of
// `all` blocks, those done before among them. What a block gives depends on the plan alone. A device or host
// short of memory halves the batch, saying so. Finishes the sink, whatever it throws: BakeStopped when the
// observer wants it, Error. `kept`: verified visibility of the plan's key, taken instead of finding it.
void bakeBlocks(const vk::Device& device, const BakePlan& plan, std::span<const uint32_t> blocks,
                std::span<const uint32_t> all, const BakeLimits& limits, BakeSink& sink,
                BakeObserver& observer, BakeTimes& times, KeptVisibility* kept = nullptr);

} // namespace relume

// Bakes the blocks of a plan and hands them to a sink.
#pragma once

#include "engine/transport/kept_visibility.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"
#include "precompute/bake/batch_plan.h"

#include <span>

namespace relume {

// The times of a bake, in seconds.
struct BakeTimes {
    double total = 0; // wall clock
    double factorization = 0;
    double occluder = 0;  // merging and simplifying the occluder
    double bounces = 0;   // gathering bounced light, without the device's passes
    double previews = 0;  // making and writing previews
    vk::PassTimes device; // device time by pass
    uint32_t batch = 0;   // largest number of points per submission
};

// Receives blocks as they are finished.
class BakeSink {
  public:
    virtual ~BakeSink() = default;
    virtual void take(uint32_t block, BakedBlock baked) = 0;
    // Returns once all blocks taken have reached their destination.
    virtual void finish() {}
};

// Bakes `blocks` in this order; it is fastest if those of a part are consecutive. Progress is reported
// relative to `all` blocks, which include those done before. A block's result depends on the plan alone. When
// device or host run out of memory, the batch is halved and the log says so. `kept`, if any, is verified
// visibility with the plan's key, used instead of computing it. Finishes the sink, also after an
// exception. Throws BakeStopped when the observer wants it, and Error.
void bakeBlocks(const vk::Device& device, const BakePlan& plan, std::span<const uint32_t> blocks,
                std::span<const uint32_t> all, const BakeLimits& limits, BakeSink& sink,
                BakeObserver& observer, BakeTimes& times, KeptVisibility* kept = nullptr);

} // namespace relume

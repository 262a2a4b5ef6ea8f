// What a bake tells while it runs, and asks.
#pragma once

#include "engine/base/error.h"

#include <cstdint>
#include <string>

namespace relume {

struct RefinementRecord;

enum class BakeStage { Occluder, Factorisation, Refinement, Bounces, Sample, Preview, Baking, Writing };

// Where a bake stands.
struct BakeStatus {
    uint64_t vertices = 0;        // of all parts
    uint64_t done = 0;            // of these, with what was found in a checkpoint
    double fraction = 0;          // of the work, in which vertices of parts weigh what they cost
    double verticesPerSecond = 0; // 0 while unknown. A resumed bake's own
    double secondsLeft = 0;       // to the last vertex
};

// All calls come from the thread that bakes.
class BakeObserver {
  public:
    virtual ~BakeObserver() = default;
    // `part` is its name while baking, for a preview too, else empty.
    virtual void stage(BakeStage, const std::string& /*part*/) {}
    // After the stage Refinement, if there is one.
    virtual void refined(const RefinementRecord&) {}
    // Before the first block: vertices that a checkpoint holds already, of how many.
    virtual void resumed(uint64_t /*done*/, uint64_t /*vertices*/) {}
    // After every few tenths of a second of baking; the last time with done == vertices. In
    // the stages Bounces, Sample and Preview of the vertices that these take alone, in the stage Refinement
    // of the points that a round looks at in a part.
    virtual void progress(const BakeStatus&) {}
    // A preview was written to the output, with such a share of the vertices baked.
    virtual void preview(double /*bakedShare*/) {}
    // Asked between submissions. If true, the bake ends with BakeStopped.
    virtual bool wantsStop() { return false; }
};

// Tells of a bake within a bake as of a stage of its own.
class StageObserver : public BakeObserver {
  public:
    StageObserver(BakeObserver& observer, BakeStage stage) : mObserver(observer), mStage(stage) {}

    void stage(BakeStage, const std::string& part) override { mObserver.stage(mStage, part); }
    void progress(const BakeStatus& status) override { mObserver.progress(status); }
    bool wantsStop() override { return mObserver.wantsStop(); }

  private:
    BakeObserver& mObserver;
    BakeStage mStage;
};

// The bake was asked to stop. What was finished is in the checkpoint, where there is one.
class BakeStopped : public Error {
  public:
    using Error::Error;
};

} // namespace relume

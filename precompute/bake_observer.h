// The interface by which a running bake reports its progress and learns that it shall stop.
#pragma once

#include "engine/base/error.h"

#include <cstdint>
#include <string>

namespace relume {

struct RefinementRecord;

enum class BakeStage { Occluder, Factorization, Refinement, Bounces, Sample, Preview, Baking, Writing };

// The progress of a bake.
struct BakeStatus {
    uint64_t vertices = 0; // of all parts, or of the shard
    uint64_t done = 0;     // those finished, including those a checkpoint held
    double fraction = 0;   // share of the work done, 0 to 1; vertices are weighted by the cost of their part
    double verticesPerSecond = 0; // of this run; 0 while unknown
    double secondsLeft = 0;       // until the last vertex is done
};

// Receives the events of a bake. All calls come from the thread that bakes.
class BakeObserver {
  public:
    virtual ~BakeObserver() = default;
    // A stage begins. `part` is the name of the part being baked; empty in stages that concern all parts.
    virtual void stage(BakeStage, const std::string& /*part*/) {}
    // Refinement is done; not called where no mesh is refined.
    virtual void refined(const RefinementRecord&) {}
    // The bake is about to start, with `done` of its `vertices` already in the checkpoint.
    virtual void resumed(uint64_t /*done*/, uint64_t /*vertices*/) {}
    // Called every few tenths of a second, the last time with done == vertices. The stages Bounces, Sample
    // and Preview count only the vertices that they bake themselves; the stage Refinement counts the points
    // that a round examines in a part.
    virtual void progress(const BakeStatus&) {}
    // A preview was written in which this share of the vertices is baked, the rest interpolated.
    virtual void preview(double /*bakedShare*/) {}
    // Polled between submissions and during long work on the host; returning true ends the bake with
    // BakeStopped.
    virtual bool wantsStop() { return false; }
};

// Reports a bake within a bake to another observer as one stage of the outer bake.
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

// Thrown when the observer stops a bake. Finished blocks remain in the checkpoint, if there is one.
class BakeStopped : public Error {
  public:
    using Error::Error;
};

} // namespace relume

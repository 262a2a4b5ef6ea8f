// The output of `relume bake` while it works: a progress bar for people, or JSON events for programs.
#pragma once

#include "engine/base/progress.h"
#include "precompute/bake_observer.h"

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace relume {

enum class ReportStyle { Quiet, Text, Json };

// Writes to stderr for Text and to stdout for Json; docs/baking.md lists the events.
class BakeReport : public BakeObserver {
  public:
    // `stoppable`: SIGINT and SIGTERM stop the bake; before its first block they end the process.
    BakeReport(ReportStyle style, bool stoppable) : mStyle(style), mStoppable(stoppable) {}

    void stage(BakeStage stage, const std::string& part) override;
    void refined(const RefinementRecord& record) override;
    void resumed(uint64_t done, uint64_t vertices) override;
    void progress(const BakeStatus& status) override;
    void preview(double bakedShare) override;
    bool wantsStop() override;

    // Prints {"event": name, …fields} on a line of its own, for Json.
    void event(const char* name, nlohmann::ordered_json fields) const;

    // Ends the progress bar, so that others can write to the terminal.
    void close() { mBar.reset(); }

    uint64_t done() const { return mDone; }
    uint64_t vertices() const { return mVertices; }

  private:
    void showBar(uint64_t vertices);

    ReportStyle mStyle;
    bool mStoppable;
    uint64_t mDone = 0, mVertices = 0;
    bool mIsAside = false, mHasPreview = false;
    std::string mStage;
    std::optional<Progress> mBar;
    uint64_t mBarVertices = 0;
    std::chrono::steady_clock::time_point mLastEvent;
};

} // namespace relume

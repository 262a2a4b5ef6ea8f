#include "apps/relume/bake_report.h"

#include "engine/base/interrupt.h"
#include "precompute/refine/refinement_record.h"

#include <cstdio>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

constexpr std::chrono::milliseconds kEventInterval{500};

const char* stageName(BakeStage stage) {
    switch (stage) {
    case BakeStage::Occluder:
        return "occluder";
    case BakeStage::Factorization:
        return "factorization";
    case BakeStage::Refinement:
        return "refinement";
    case BakeStage::Bounces:
        return "bounces";
    case BakeStage::Sample:
        return "sample";
    case BakeStage::Preview:
        return "preview";
    case BakeStage::Baking:
        return "baking";
    case BakeStage::Writing:
        return "writing";
    }
    return "";
}

} // namespace

void BakeReport::event(const char* name, nlohmann::ordered_json fields) const {
    if (mStyle != ReportStyle::Json) return;
    nlohmann::ordered_json line = {{"event", name}};
    line.update(fields);
    fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    std::fflush(stdout);
}

void BakeReport::stage(BakeStage stage, const std::string& part) {
    mIsAside = stage == BakeStage::Refinement || stage == BakeStage::Bounces || stage == BakeStage::Sample ||
               stage == BakeStage::Preview;
    mStage = stageName(stage);
    event("stage", {{"stage", mStage}, {"part", part}});
    if (!part.empty()) mStage += " " + part;
    if (mStyle != ReportStyle::Text) return;
    if (!mBar) mBar.emplace(mStage, 0, "vertices");
    mBar->setTitle(mStage);
}

void BakeReport::refined(const RefinementRecord& record) {
    event("refined", {{"wanted_error", record.wanted},
                      {"start_error", record.startError},
                      {"error", record.error},
                      {"start_vertices", record.startVertices},
                      {"vertices", record.vertices}});
    close();
    if (mStyle == ReportStyle::Text)
        spdlog::info("refined: {} vertices with an error of {:.2f} % become {} with {:.2f} %{}",
                     record.startVertices, 100 * record.startError, record.vertices, 100 * record.error,
                     record.isAuto ? " (errors are of coarse parts; --refine off leaves them)" : "");
    if (record.error > record.wanted && !record.isAuto)
        spdlog::warn(
            "--refine {}: not reached, the error is {:.4f}; there are at most {} vertices, and edges "
            "of a few visibility offsets stay whole",
            record.wanted, record.error, kMostRefinedVertices);
}

void BakeReport::resumed(uint64_t done, uint64_t vertices) {
    mDone = done;
    mVertices = vertices;
    event("start", {{"vertices", vertices}, {"done", done}});
    if (mStoppable) catchInterrupts();
    showBar(vertices);
}

void BakeReport::showBar(uint64_t vertices) {
    if (mStyle == ReportStyle::Text) mBar.emplace(mStage, vertices, "vertices");
    mBarVertices = vertices;
}

void BakeReport::progress(const BakeStatus& status) {
    if (!mIsAside) mDone = status.done;
    if (status.vertices != mBarVertices) showBar(status.vertices);
    if (mBar) mBar->update({status.done, status.fraction, status.verticesPerSecond, status.secondsLeft});
    const auto now = std::chrono::steady_clock::now();
    if (status.done < status.vertices && now - mLastEvent < kEventInterval) return;
    mLastEvent = now;
    event("progress", {{"done", status.done},
                       {"vertices", status.vertices},
                       {"fraction", status.fraction},
                       {"vertices_per_second", status.verticesPerSecond},
                       {"seconds_left", status.secondsLeft}});
}

void BakeReport::preview(double bakedShare) {
    event("preview", {{"baked_share", bakedShare}});
    if (mStyle == ReportStyle::Text && !mHasPreview) {
        mBar.reset(); // end its line before logging
        spdlog::info("a preview is there; it is refined as the bake goes on");
        showBar(mVertices);
    }
    mHasPreview = true;
}

bool BakeReport::wantsStop() { return mStoppable && caughtInterrupt() != 0; }

} // namespace relume

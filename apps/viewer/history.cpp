#include "apps/viewer/history.h"

#include <tuple>

namespace relume {

namespace {

constexpr size_t kMostSteps = 500;

// References to all that is edited but the exposure. Environments are only ever added, so their number stays
// good.
auto edits(auto& state) {
    auto& light = state.light;
    return std::tie(light.environment, light.environmentGain, light.sky, light.lamps, light.strokes,
                    light.rotation, light.file, light.fileName, light.selection, state.material, state.terms,
                    state.addsResidual, state.samples, state.tone, state.exposesItself, state.background,
                    state.backgroundBlur, state.ground, state.fovDegrees);
}

// An exposure that was found for the user is no edit.
bool isSame(const SceneState& a, const SceneState& b) {
    return edits(a) == edits(b) && (a.exposesItself || a.exposure == b.exposure);
}

void restore(SceneState& state, const SceneState& kept) {
    edits(state) = edits(kept);
    if (kept.exposesItself)
        state.wantsExposure = true;
    else
        state.exposure = kept.exposure;
    if (state.orbit) state.orbit->verticalFov = glm::radians(state.fovDegrees);
}

} // namespace

void History::keep(const SceneState& state) {
    if (mNow && isSame(*mNow, state)) return;
    if (mNow) mBefore.push_back(*mNow);
    if (mBefore.size() > kMostSteps) mBefore.erase(mBefore.begin());
    mAfter.clear();
    mNow = state;
}

bool History::undo(SceneState& state) {
    keep(state);
    return move(state, mBefore, mAfter);
}

bool History::redo(SceneState& state) {
    keep(state);
    return move(state, mAfter, mBefore);
}

bool History::move(SceneState& state, std::vector<SceneState>& from, std::vector<SceneState>& to) {
    if (from.empty()) return false;
    to.push_back(std::move(*mNow));
    mNow = std::move(from.back());
    from.pop_back();
    restore(state, *mNow);
    return true;
}

} // namespace relume

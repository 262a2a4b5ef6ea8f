// Undo and redo of what is edited: light, materials and the settings of the picture, but not the camera.
#pragma once

#include "apps/viewer/scene_state.h"

#include <vector>

namespace relume {

class History {
  public:
    // Makes what was edited since the last call a step to undo. Call it when nothing is being dragged: a drag
    // is one step.
    void keep(const SceneState& state);

    // Takes the last step back, or takes it again. Returns false where there is none.
    bool undo(SceneState& state);
    bool redo(SceneState& state);

  private:
    bool move(SceneState& state, std::vector<SceneState>& from, std::vector<SceneState>& to);

    std::optional<SceneState> mNow; // as kept last
    std::vector<SceneState> mBefore, mAfter;
};

} // namespace relume

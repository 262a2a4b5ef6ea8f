// Translates input into changes of the scene's state, and commands.
#pragma once

#include "apps/viewer/scene_state.h"
#include "apps/viewer/window.h"

#include <array>

namespace relume {

// Requests by controls other than changes of state.
enum class Command {
    None,
    Focus,         // the point under the cursor
    ExplainVertex, // under the cursor
    Pick,          // the part under the cursor
    Undo,
    Redo,
    Screenshot,
    SaveSession,
    Sheet, // of all materials and lights
    Record,
    Capture,
    ReloadShaders,
    FullScreen,
    NextMaterial,
    NextEnvironment,
    NextModel,
    FewerTerms,
    MoreTerms,
    Quit
};

// Keys and what they do, for the help.
struct KeyHelp {
    const char *keys, *action;
};
std::vector<KeyHelp> keyHelp();

class Controls {
  public:
    // Handles one input in a window of this size. `model` is the bounds of the model shown, null if none is.
    Command take(const InputEvent& event, SceneState& state, ivec2 size, const Bounds* model);

    bool isDragging() const { return mHeld >= 0; }
    vec2 cursor() const { return mCursor; }

  private:
    Command takeButton(const InputEvent& event, const SceneState& state, ivec2 size);
    void takeMove(vec2 place, SceneState& state, ivec2 size);
    Command takeKey(const InputEvent& event, SceneState& state);

    int mHeld = -1, mModifiers = 0; // button of a drag, and modifiers held when it began
    bool mDragsSplit = false;       // the drag moves the line between two images
    vec2 mPressed{-1e6f};           // where the left button went down, until the cursor leaves that place
    vec2 mCursor{0};
    vec2 mLastClick{-1e6f}; // place of the last left click, and its time below
    double mLastClickTime = 0;
    struct KeptView {
        std::optional<Orbit> orbit;
        float fovDegrees = 0;
    };
    std::array<KeptView, 9> mViews; // views stored on number keys
};

} // namespace relume

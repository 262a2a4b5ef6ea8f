// What hands do, as changes of what is looked at.
#pragma once

#include "apps/viewer/scene_state.h"
#include "apps/viewer/window.h"

#include <array>

namespace relume {

// What a control asks for beyond changes of the state.
enum class Command {
    None,
    Focus, // on what is under the cursor
    Why,   // explain what is under the cursor
    Pick,  // the part under the cursor
    Undo,
    Redo,
    Screenshot,
    SaveSession,
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

// A key, and what it does, as the help shows it.
struct KeyHelp {
    const char *keys, *action;
};
std::vector<KeyHelp> keyHelp();

class Controls {
  public:
    // One input, in a window of this size. `model`: what is looked at, if there is anything; its bounds.
    Command take(const InputEvent& event, SceneState& state, ivec2 size, const Bounds* model);

    bool isDragging() const { return mHeld >= 0; }
    vec2 cursor() const { return mCursor; }

  private:
    Command takeButton(const InputEvent& event, const SceneState& state, ivec2 size);
    void takeMove(vec2 place, SceneState& state, ivec2 size);
    Command takeKey(const InputEvent& event, SceneState& state);

    int mHeld = -1, mModifiers = 0; // the button of a drag, and what was held with it
    bool mDragsSplit = false;       // the line between two images
    vec2 mPressed{-1e6f};           // where the left button went down, until it moves from there
    vec2 mCursor{0};
    vec2 mLastClick{-1e6f}; // where the left button was pressed last, and when
    double mLastClickTime = 0;
    struct KeptView {
        std::optional<Orbit> orbit;
        float fovDegrees = 0;
    };
    std::array<KeptView, 9> mViews; // of number keys
};

} // namespace relume

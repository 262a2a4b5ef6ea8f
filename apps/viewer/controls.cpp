#include "apps/viewer/controls.h"

#include <GLFW/glfw3.h>
#include <cmath>

namespace relume {

namespace {

constexpr float kDegreesPerWidth = 360; // of the light, for a drag across the window

} // namespace

std::vector<KeyHelp> keyHelp() {
    return {
        {"Left drag", "orbit"},
        {"Middle drag, Shift + left drag", "move the view"},
        {"Wheel", "nearer, farther, towards the cursor"},
        {"Shift + right drag", "turn the light"},
        {"Enter", "the default view"},
        {"1 to 9, Ctrl + 1 to 9", "go to a kept view, keep this one"},
        {"T", "turntable"},
        {"E", "the next environment"},
        {"M", "the next material"},
        {"Space", "play and pause a light that moves"},
        {"Tab", "panels"},
        {"H", "this help"},
        {"F9", "start and stop a timing capture"},
        {"F11", "full screen"},
        {"F12", "screenshot: .png as it is seen, .exr of linear radiance"},
        {"Ctrl + Q", "quit"},
        {"Drop files", ".relume, meshes, scenes; environments and lights (.exr, .hdr, .json)"},
    };
}

Command Controls::take(const InputEvent& event, SceneState& state, ivec2 size, const Bounds* model) {
    switch (event.kind) {
    case InputEvent::Kind::Button:
        if (event.isDown && mHeld < 0) {
            mHeld = event.code;
            mModifiers = event.modifiers;
        } else if (!event.isDown && event.code == mHeld)
            mHeld = -1;
        mCursor = event.place;
        return Command::None;
    case InputEvent::Kind::Move: {
        const vec2 moved = event.place - mCursor;
        mCursor = event.place;
        const bool withShift = mModifiers & GLFW_MOD_SHIFT;
        if (mHeld == GLFW_MOUSE_BUTTON_RIGHT && withShift)
            state.light.rotation =
                std::remainder(state.light.rotation + kDegreesPerWidth * moved.x / float(size.x), 360.0f);
        if (!state.orbit) return Command::None;
        if (mHeld == GLFW_MOUSE_BUTTON_LEFT && !withShift) state.orbit->turn(moved, float(size.y));
        if (mHeld == GLFW_MOUSE_BUTTON_MIDDLE || (mHeld == GLFW_MOUSE_BUTTON_LEFT && withShift))
            state.orbit->pan(moved, float(size.y));
        return Command::None;
    }
    case InputEvent::Kind::Scroll:
        if (state.orbit && model)
            state.orbit->zoom(event.place.y, 2.0f * mCursor / vec2(size) - 1.0f,
                              float(size.x) / float(size.y), model->radius());
        return Command::None;
    case InputEvent::Kind::Key:
        return event.isDown ? takeKey(event, state) : Command::None;
    default:
        return Command::None;
    }
}

Command Controls::takeKey(const InputEvent& event, SceneState& state) {
    const bool withControl = event.modifiers & GLFW_MOD_CONTROL;
    if (event.code >= GLFW_KEY_1 && event.code <= GLFW_KEY_9) {
        std::optional<Orbit>& view = mViews[size_t(event.code - GLFW_KEY_1)];
        if (withControl)
            view = state.orbit;
        else if (view)
            state.orbit = view;
        return Command::None;
    }
    switch (event.code) {
    case GLFW_KEY_ENTER:
        state.orbit.reset();
        return Command::None;
    case GLFW_KEY_T:
        state.turns = !state.turns;
        return Command::None;
    case GLFW_KEY_SPACE:
        state.light.plays = !state.light.plays;
        return Command::None;
    case GLFW_KEY_TAB:
        state.showsPanels = !state.showsPanels;
        return Command::None;
    case GLFW_KEY_H:
        state.showsHelp = !state.showsHelp;
        return Command::None;
    case GLFW_KEY_ESCAPE:
        state.showsHelp = false;
        return Command::None;
    case GLFW_KEY_E:
        return Command::NextEnvironment;
    case GLFW_KEY_M:
        return Command::NextMaterial;
    case GLFW_KEY_F9:
        return Command::Capture;
    case GLFW_KEY_F11:
        return Command::FullScreen;
    case GLFW_KEY_F12:
        return Command::Screenshot;
    case GLFW_KEY_Q:
        return withControl ? Command::Quit : Command::None;
    default:
        return Command::None;
    }
}

} // namespace relume

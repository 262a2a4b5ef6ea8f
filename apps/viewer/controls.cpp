#include "apps/viewer/controls.h"

#include <GLFW/glfw3.h>
#include <cmath>

namespace relume {

namespace {

constexpr float kDegreesPerWidth = 360; // by which a drag across the window turns the light
constexpr double kDoubleClick = 0.4;    // seconds
constexpr float kNear = 6;              // pixels

Compare next(Compare compare) { return Compare((int(compare) + 1) % (int(Compare::Difference) + 1)); }
Inspect next(Inspect inspect) { return Inspect((int(inspect) + 1) % (int(Inspect::Density) + 1)); }

} // namespace

std::vector<KeyHelp> keyHelp() {
    return {
        {"Left drag", "orbit"},
        {"Middle drag, Shift + left drag", "move the view"},
        {"Wheel", "nearer, farther, towards the cursor"},
        {"Click, double click", "pick the part, look at what is there"},
        {"Shift + right drag", "turn the light"},
        {"Left drag of a lamp", "move it around the object"},
        {"Enter", "the default view"},
        {"1 to 9, Ctrl + 1 to 9", "go to a kept view, keep this one"},
        {"T", "turntable"},
        {"Space", "play and pause the light: a file's time, the day, else a turn"},
        {"E, M, B", "the next environment, material, bake"},
        {"- and =", "fewer and more terms of the K"},
        {"C", "compare: split, the reference alone, the difference, off"},
        {"I", "inspect: wireframe, normals, density of triangles, off"},
        {"L", "the light vector, as given and as kept"},
        {"W", "why the vertex under the cursor has its color"},
        {"Tab, H, Escape", "panels, this help, close help and explanation"},
        {"F5", "build the shaders anew"},
        {"F9", "start and stop a timing capture"},
        {"F11", "full screen"},
        {"G", "a contact sheet: every material under every light that is read"},
        {"F12", "screenshot: .png as it is seen, .exr of linear radiance"},
        {"Ctrl + Z, Ctrl + Shift + Z", "undo and redo changes of light, material and picture"},
        {"Ctrl + S", "save the session: view, light and materials"},
        {"Ctrl + F12", "start and stop recording images"},
        {"Ctrl + Q", "quit"},
        {"Drop files", ".relume, meshes, scenes; environments, lights and sessions (.exr, .hdr, .json)"},
    };
}

Command Controls::take(const InputEvent& event, SceneState& state, ivec2 size, const Bounds* model) {
    switch (event.kind) {
    case InputEvent::Kind::Button:
        return takeButton(event, state, size);
    case InputEvent::Kind::Move:
        takeMove(event.place, state, size);
        return Command::None;
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

Command Controls::takeButton(const InputEvent& event, const SceneState& state, ivec2 size) {
    mCursor = event.place;
    if (!event.isDown) {
        const bool isClick = event.code == mHeld && event.code == GLFW_MOUSE_BUTTON_LEFT &&
                             glm::distance(event.place, mPressed) < kNear;
        if (event.code == mHeld) mHeld = -1;
        return isClick ? Command::Pick : Command::None;
    }
    if (mHeld >= 0) return Command::None;
    mHeld = event.code;
    mModifiers = event.modifiers;
    const bool isPlain = event.code == GLFW_MOUSE_BUTTON_LEFT && !event.modifiers;
    mDragsSplit = isPlain && state.compare == Compare::Split &&
                  std::abs(event.place.x - state.split * float(size.x)) < kNear;
    mPressed = isPlain && !mDragsSplit ? event.place : vec2(-1e6f);
    if (!isPlain) return Command::None;
    const bool isDouble =
        event.seconds - mLastClickTime < kDoubleClick && glm::distance(event.place, mLastClick) < kNear;
    mLastClick = isDouble ? vec2(-1e6f) : event.place; // three clicks are not two double clicks
    mLastClickTime = event.seconds;
    return isDouble ? Command::Focus : Command::None;
}

void Controls::takeMove(vec2 place, SceneState& state, ivec2 size) {
    const vec2 moved = place - mCursor;
    mCursor = place;
    if (glm::distance(place, mLastClick) >= kNear) mLastClick = vec2(-1e6f);
    if (glm::distance(place, mPressed) >= kNear) mPressed = vec2(-1e6f);
    const bool withShift = mModifiers & GLFW_MOD_SHIFT;
    if (mHeld == GLFW_MOUSE_BUTTON_RIGHT && withShift)
        state.light.rotation =
            std::remainder(state.light.rotation + kDegreesPerWidth * moved.x / float(size.x), 360.0f);
    if (mHeld == GLFW_MOUSE_BUTTON_LEFT && mDragsSplit) {
        state.split = glm::clamp(place.x / float(size.x), 0.0f, 1.0f);
        return;
    }
    if (!state.orbit) return;
    if (mHeld == GLFW_MOUSE_BUTTON_LEFT && !withShift) state.orbit->turn(moved, float(size.y));
    if (mHeld == GLFW_MOUSE_BUTTON_MIDDLE || (mHeld == GLFW_MOUSE_BUTTON_LEFT && withShift))
        state.orbit->pan(moved, float(size.y));
}

Command Controls::takeKey(const InputEvent& event, SceneState& state) {
    const bool withControl = event.modifiers & GLFW_MOD_CONTROL;
    if (event.code >= GLFW_KEY_1 && event.code <= GLFW_KEY_9) {
        KeptView& view = mViews[size_t(event.code - GLFW_KEY_1)];
        if (withControl) {
            view = {state.orbit, state.fovDegrees};
        } else if (view.orbit) {
            state.orbit = view.orbit;
            state.fovDegrees = view.fovDegrees;
        }
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
        state.showsHelp = state.showsExplanation = false;
        return Command::None;
    case GLFW_KEY_E:
        return Command::NextEnvironment;
    case GLFW_KEY_M:
        return Command::NextMaterial;
    case GLFW_KEY_B:
        return Command::NextModel;
    case GLFW_KEY_MINUS:
        return Command::FewerTerms;
    case GLFW_KEY_EQUAL:
        return Command::MoreTerms;
    case GLFW_KEY_C:
        state.compare = next(state.compare);
        return Command::None;
    case GLFW_KEY_I:
        state.inspect = next(state.inspect);
        return Command::None;
    case GLFW_KEY_L:
        state.showsLight = !state.showsLight;
        return Command::None;
    case GLFW_KEY_W:
        return Command::ExplainVertex;
    case GLFW_KEY_G:
        return Command::Sheet;
    case GLFW_KEY_F5:
        return Command::ReloadShaders;
    case GLFW_KEY_F9:
        return Command::Capture;
    case GLFW_KEY_F11:
        return Command::FullScreen;
    case GLFW_KEY_F12:
        return withControl ? Command::Record : Command::Screenshot;
    case GLFW_KEY_Z:
        if (!withControl) return Command::None;
        return event.modifiers & GLFW_MOD_SHIFT ? Command::Redo : Command::Undo;
    case GLFW_KEY_Y:
        return withControl ? Command::Redo : Command::None;
    case GLFW_KEY_S:
        return withControl ? Command::SaveSession : Command::None;
    case GLFW_KEY_Q:
        return withControl ? Command::Quit : Command::None;
    default:
        return Command::None;
    }
}

} // namespace relume

// What keys, drags and clicks do to what is looked at.
#include "apps/viewer/controls.h"
#include "tests/support/capture_binding.h"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

using namespace relume;
using Kind = InputEvent::Kind;

namespace {

constexpr ivec2 kSize(400, 300);
constexpr int kLeft = GLFW_MOUSE_BUTTON_LEFT, kRight = GLFW_MOUSE_BUTTON_RIGHT,
              kMiddle = GLFW_MOUSE_BUTTON_MIDDLE, kShift = GLFW_MOD_SHIFT, kControl = GLFW_MOD_CONTROL;

struct Hand {
    Controls controls;
    SceneState state;
    Bounds model{vec3(-1), vec3(1)};

    Hand() { state.orbit = Orbit{.distance = 5}; }

    Command take(const InputEvent& event) { return controls.take(event, state, kSize, &model); }
    Command press(vec2 place, int button = kLeft, int modifiers = 0, double seconds = 0) {
        return take({Kind::Button, button, true, modifiers, place, {}, seconds});
    }
    Command release(vec2 place, int button = kLeft) { return take({Kind::Button, button, false, 0, place}); }
    void move(vec2 place) { take({Kind::Move, 0, false, 0, place}); }
    Command key(int code, int modifiers = 0) {
        const Command command = take({Kind::Key, code, true, modifiers});
        CHECK_EQ(take({Kind::Key, code, false, modifiers}), Command::None);
        return command;
    }
    void drag(vec2 from, vec2 to, int button, int modifiers = 0) {
        press(from, button, modifiers);
        move(0.5f * (from + to));
        move(to);
        release(to, button);
    }
    Command click(vec2 place, double seconds, int modifiers = 0) {
        const Command command = press(place, kLeft, modifiers, seconds);
        release(place);
        return command;
    }
};

} // namespace

TEST_CASE("controls: drags turn, move, and turn the light, each as its button says") {
    Hand hand;
    const Orbit start = *hand.state.orbit;
    hand.drag({100, 100}, {150, 130}, kLeft);
    CHECK(hand.state.orbit->azimuth == doctest::Approx(-0.5)); // 3 radians a height
    CHECK(hand.state.orbit->elevation == doctest::Approx(0.3));
    CHECK_EQ(hand.state.orbit->target, start.target);
    CHECK_EQ(hand.state.light.rotation, 0);
    CHECK_FALSE(hand.controls.isDragging());
    const Orbit turned = *hand.state.orbit;
    hand.move({10, 10}); // nothing is held
    CHECK_EQ(*hand.state.orbit, turned);

    hand.state.orbit = start;
    hand.drag({100, 100}, {150, 130}, kMiddle);
    const Orbit panned = *hand.state.orbit;
    CHECK_NE(panned.target, start.target);
    CHECK_EQ(panned.azimuth, start.azimuth);
    hand.state.orbit = start;
    hand.drag({100, 100}, {150, 130}, kLeft, kShift);
    CHECK_EQ(*hand.state.orbit, panned);

    hand.drag({100, 100}, {150, 130}, kRight, kShift);
    CHECK_EQ(*hand.state.orbit, panned);
    CHECK(hand.state.light.rotation == doctest::Approx(45)); // a turn a width
    hand.drag({0, 0}, {300, 0}, kRight, kShift);
    CHECK(hand.state.light.rotation == doctest::Approx(-45)); // 315
    hand.drag({0, 0}, {300, 0}, kRight);
    CHECK(hand.state.light.rotation == doctest::Approx(-45));
}

TEST_CASE("controls: a second button neither takes a drag over nor ends it") {
    Hand hand;
    hand.press({100, 100});
    hand.press({100, 100}, kRight, kShift);
    hand.move({120, 100});
    CHECK_EQ(hand.state.light.rotation, 0);
    CHECK(hand.state.orbit->azimuth == doctest::Approx(-0.2));
    hand.release({120, 100}, kRight);
    CHECK(hand.controls.isDragging());
    hand.move({140, 100});
    CHECK(hand.state.orbit->azimuth == doctest::Approx(-0.4));
    hand.release({140, 100});
    CHECK_FALSE(hand.controls.isDragging());
}

TEST_CASE("controls: two clicks at one place and moment are a double click") {
    const vec2 place(200, 150);
    Hand hand;
    CHECK_EQ(hand.click(place, 10), Command::None);
    CHECK_EQ(hand.click(place + vec2(2, 1), 10.3), Command::Focus);
    CHECK_EQ(hand.click(place, 10.5), Command::None); // three are not two doubles
    CHECK_EQ(hand.click(place, 10.7), Command::Focus);
    CHECK_EQ(hand.controls.cursor(), place);

    CHECK_EQ(hand.click(place, 20), Command::None);
    CHECK_EQ(hand.click(place, 20.5), Command::None); // too late
    CHECK_EQ(hand.click(place + vec2(8, 0), 20.6), Command::None);
    CHECK_EQ(hand.click(place + vec2(8, 0), 20.7, kShift), Command::None);

    CHECK_EQ(hand.press(place, kLeft, 0, 30), Command::None);
    hand.move(place + vec2(30, 0)); // a drag, there and back
    hand.move(place);
    hand.release(place);
    CHECK_EQ(hand.click(place, 30.2), Command::None);
}

TEST_CASE("controls: the line between two images is dragged where it is") {
    Hand hand;
    hand.state.compare = Compare::Split;
    const Orbit start = *hand.state.orbit;
    hand.drag({203, 20}, {100, 90}, kLeft);
    CHECK(hand.state.split == doctest::Approx(0.25));
    CHECK_EQ(*hand.state.orbit, start);
    hand.drag({97, 20}, {-50, 20}, kLeft);
    CHECK_EQ(hand.state.split, 0);
    hand.drag({3, 20}, {1000, 20}, kLeft);
    CHECK_EQ(hand.state.split, 1);
    hand.state.split = 0.5f;
    hand.drag({215, 20}, {100, 20}, kLeft); // beside it
    CHECK_EQ(hand.state.split, 0.5f);
    CHECK_NE(*hand.state.orbit, start);
    hand.state.compare = Compare::Difference; // there is none
    hand.drag({200, 20}, {100, 20}, kLeft);
    CHECK_EQ(hand.state.split, 0.5f);
}

TEST_CASE("controls: number keys keep views, and go back to them") {
    Hand hand;
    const Orbit first = *hand.state.orbit;
    CHECK_EQ(hand.key(GLFW_KEY_1, kControl), Command::None);
    hand.state.orbit->azimuth = 1;
    hand.state.orbit->verticalFov = 1;
    hand.state.fovDegrees = glm::degrees(1.0f);
    const Orbit second = *hand.state.orbit;
    hand.key(GLFW_KEY_9, kControl);
    hand.key(GLFW_KEY_1);
    CHECK_EQ(*hand.state.orbit, first);
    CHECK_EQ(hand.state.fovDegrees, 35);
    hand.key(GLFW_KEY_5); // none is kept there
    CHECK_EQ(*hand.state.orbit, first);
    hand.key(GLFW_KEY_9);
    CHECK_EQ(*hand.state.orbit, second);
    CHECK_EQ(hand.state.fovDegrees, glm::degrees(1.0f));
    hand.key(GLFW_KEY_ENTER);
    CHECK_FALSE(hand.state.orbit);
    hand.key(GLFW_KEY_1, kControl); // nothing to keep
    hand.key(GLFW_KEY_9);
    CHECK_EQ(*hand.state.orbit, second);
    hand.key(GLFW_KEY_1);
    CHECK_EQ(*hand.state.orbit, second);
}

TEST_CASE("controls: keys") {
    Hand hand;
    const std::pair<int, Command> commands[] = {{GLFW_KEY_E, Command::NextEnvironment},
                                                {GLFW_KEY_M, Command::NextMaterial},
                                                {GLFW_KEY_B, Command::NextModel},
                                                {GLFW_KEY_MINUS, Command::FewerTerms},
                                                {GLFW_KEY_EQUAL, Command::MoreTerms},
                                                {GLFW_KEY_W, Command::ExplainVertex},
                                                {GLFW_KEY_F5, Command::ReloadShaders},
                                                {GLFW_KEY_F9, Command::Capture},
                                                {GLFW_KEY_F11, Command::FullScreen},
                                                {GLFW_KEY_F12, Command::Screenshot},
                                                {GLFW_KEY_G, Command::Sheet},
                                                {GLFW_KEY_Q, Command::None},
                                                {GLFW_KEY_Z, Command::None}};
    for (const auto& [code, command] : commands) {
        CAPTURE_BINDING(code);
        CHECK_EQ(hand.key(code), command);
    }
    CHECK_EQ(hand.key(GLFW_KEY_F12, kControl), Command::Record);
    CHECK_EQ(hand.key(GLFW_KEY_Q, kControl), Command::Quit);

    const std::pair<int, bool SceneState::*> flags[] = {{GLFW_KEY_T, &SceneState::turns},
                                                        {GLFW_KEY_TAB, &SceneState::showsPanels},
                                                        {GLFW_KEY_H, &SceneState::showsHelp},
                                                        {GLFW_KEY_L, &SceneState::showsLight}};
    for (const auto& [code, flag] : flags) {
        const bool before = hand.state.*flag;
        hand.key(code);
        CHECK_NE(hand.state.*flag, before);
        hand.key(code);
        CHECK_EQ(hand.state.*flag, before);
    }
    hand.key(GLFW_KEY_SPACE);
    CHECK(hand.state.light.plays);
    hand.key(GLFW_KEY_H);
    hand.state.showsExplanation = true;
    hand.key(GLFW_KEY_ESCAPE);
    CHECK_FALSE(hand.state.showsHelp);
    CHECK_FALSE(hand.state.showsExplanation);
    for (const Compare next : {Compare::Split, Compare::Reference, Compare::Difference, Compare::Off}) {
        hand.key(GLFW_KEY_C);
        CHECK_EQ(hand.state.compare, next);
    }
    for (const Inspect next : {Inspect::Wireframe, Inspect::Normals, Inspect::Density, Inspect::Off}) {
        hand.key(GLFW_KEY_I);
        CHECK_EQ(hand.state.inspect, next);
    }
}

TEST_CASE("controls: the wheel goes to what is under the cursor, and needs something to be there") {
    Hand hand;
    hand.move({300, 75});
    hand.take({Kind::Scroll, 0, false, 0, {0, 2}});
    Orbit same{.distance = 5};
    same.zoom(2, {0.5f, -0.5f}, 4.0f / 3, hand.model.radius());
    CHECK_EQ(*hand.state.orbit, same);
    hand.controls.take({Kind::Scroll, 0, false, 0, {0, 2}}, hand.state, kSize, nullptr);
    CHECK_EQ(*hand.state.orbit, same);
    hand.state.orbit.reset();
    hand.drag({100, 100}, {200, 200}, kLeft);
    hand.take({Kind::Scroll, 0, false, 0, {0, 2}});
    CHECK_FALSE(hand.state.orbit);
}

TEST_CASE("controls: a click picks, a drag does not") {
    Hand hand;
    hand.press({100, 100});
    CHECK_EQ(hand.release({102, 101}), Command::Pick);
    hand.press({100, 100});
    hand.move({150, 100});
    hand.move({100, 100});
    CHECK_EQ(hand.release({100, 100}), Command::None);
    hand.press({100, 100}, kRight);
    CHECK_EQ(hand.release({100, 100}, kRight), Command::None);
    hand.press({100, 100}, kLeft, kShift);
    CHECK_EQ(hand.release({100, 100}), Command::None);
}

TEST_CASE("controls: undo and redo need Ctrl") {
    Hand hand;
    CHECK_EQ(hand.key(GLFW_KEY_Z), Command::None);
    CHECK_EQ(hand.key(GLFW_KEY_Z, kControl), Command::Undo);
    CHECK_EQ(hand.key(GLFW_KEY_Z, kControl | kShift), Command::Redo);
    CHECK_EQ(hand.key(GLFW_KEY_Y, kControl), Command::Redo);
}

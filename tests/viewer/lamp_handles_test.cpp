// Lamps dragged on their sphere.
#include "apps/viewer/lamp_handles.h"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

using namespace relume;
using Kind = InputEvent::Kind;

namespace {

constexpr ivec2 kSquareSize(400, 400);

// An object of radius 1 about the origin, seen from +Z; lamps move on a sphere of 1.25.
struct Stage {
    Bounds model{vec3(-1 / std::sqrt(3.0f)), vec3(1 / std::sqrt(3.0f))};
    Camera camera{{0, 0, 6}, {0, 0, 0}, 0.6f};
    LightState light;
    LampHandles handles;

    Stage() { light.environments.push_back({EnvironmentChoice::Kind::DaySky, "day"}); }

    bool take(const InputEvent& event) { return handles.take(event, light, camera, model, kSquareSize); }
    bool press(vec2 place, int button = GLFW_MOUSE_BUTTON_LEFT, int modifiers = 0) {
        return take({Kind::Button, button, true, modifiers, place});
    }
    bool release() { return take({Kind::Button, GLFW_MOUSE_BUTTON_LEFT, false, 0, {0, 0}}); }
    bool move(vec2 place) { return take({Kind::Move, 0, false, 0, place}); }
    vec3 direction(size_t lamp = 0) const {
        return directionAt(light.lamps[lamp].azimuth + light.rotation, light.lamps[lamp].elevation);
    }
    vec2 place(size_t lamp = 0) const { return *pixelOf(1.25f * direction(lamp), camera, kSquareSize); }
};

} // namespace

TEST_CASE("lamp handles: on the near side a handle stays under the cursor") {
    for (const float rotation : {0.0f, 130.0f}) {
        Stage stage;
        stage.light.rotation = rotation;
        stage.light.lamps = {{.azimuth = 60 - rotation, .elevation = 70},
                             {.azimuth = -rotation, .elevation = 0}};
        const vec3 other = stage.direction(0);
        CHECK_FALSE(stage.move({200, 200}));
        CHECK_FALSE(stage.press({320, 320})); // nothing is there
        CHECK(stage.press({200, 200}));       // towards the eye
        CHECK(stage.handles.isDragging());
        for (const vec2 cursor : {vec2(230, 190), vec2(250, 150), vec2(140, 260)}) {
            CHECK(stage.move(cursor));
            CHECK(glm::distance(stage.place(1), cursor) < 1.5f);
            CHECK_GT(stage.direction(1).z, 0);
        }
        CHECK_LE(std::abs(stage.light.lamps[1].azimuth), 180);
        CHECK_EQ(stage.direction(0), other);
        CHECK(stage.release());
        CHECK_FALSE(stage.move({200, 200}));
        CHECK_FALSE(stage.release()); // somebody else's
        CHECK(glm::distance(stage.place(1), vec2(140, 260)) < 1.5f);
    }
}

TEST_CASE("lamp handles: round the rim to the far side, and back") {
    Stage stage;
    stage.light.lamps = {{.azimuth = 0, .elevation = 0}};
    const float rim = [&] { // of the sphere's outline, from its middle
        const float sine = 1.25f / 6;
        return std::tan(std::asin(sine)) / std::tan(0.3f) * 200;
    }();
    REQUIRE(stage.press({200, 200}));
    stage.move({200 + 0.9f * rim, 200});
    CHECK_GT(stage.direction().z, 0);
    stage.move({200 + 1.3f * rim, 200}); // beside it: the rim
    CHECK(stage.direction().x == doctest::Approx(1).epsilon(0.05));
    CHECK(glm::distance(stage.place(), vec2(200 + rim, 200)) < 3);
    stage.move({200, 200 - 2 * rim}); // along it
    CHECK(stage.direction().y == doctest::Approx(1).epsilon(0.05));
    const vec2 inside(200 + 0.3f * rim, 200 - 0.5f * rim);
    stage.move(inside);
    CHECK_LT(stage.direction().z, 0);
    CHECK(glm::distance(stage.place(), inside) < 1.5f);
    stage.move({200, 210});
    CHECK_LT(stage.direction().z, -0.9f);
    CHECK(stage.release());
    // Taken up again it is where it was.
    CHECK(stage.press(stage.place()));
    stage.move({200, 230});
    CHECK_LT(stage.direction().z, 0);
    stage.move({200, 380});
    stage.move({200, 230});
    CHECK_GT(stage.direction().z, 0);
}

TEST_CASE("lamp handles: are there for the left button alone, and where there are lamps") {
    Stage stage;
    CHECK_FALSE(stage.press({200, 200}));
    stage.light.lamps = {{.azimuth = 0, .elevation = 0}};
    CHECK_FALSE(stage.press({200, 200}, GLFW_MOUSE_BUTTON_RIGHT));
    CHECK_FALSE(stage.press({200, 200}, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_SHIFT));
    CHECK_FALSE(stage.take({Kind::Key, GLFW_KEY_A, true}));
    CHECK(stage.press({200, 200}));
    stage.light.lamps.clear(); // by its panel
    CHECK_FALSE(stage.move({100, 100}));
    CHECK_FALSE(stage.handles.isDragging());
    stage.light.lamps = {{.azimuth = 0, .elevation = 0}};
    stage.light.file = std::make_shared<MovingLight>(Light{});
    CHECK_FALSE(stage.press({200, 200}));
}

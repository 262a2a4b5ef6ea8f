// Settings by name, from scripts and from the last time.
#include "apps/viewer/settings.h"

#include "tests/support/capture_binding.h"
#include "tests/support/failure.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

SceneState freshState() {
    SceneState state;
    state.light.environments = {{EnvironmentChoice::Kind::BuiltIn, "sky"},
                                {EnvironmentChoice::Kind::DaySky, "day sky"}};
    return state;
}

std::string settingFailure(const std::string& name, const json& value) {
    SceneState state = freshState();
    const Bounds model{vec3(-1), vec3(1)};
    state.orbit = Orbit{};
    return failureOf([&] { applySetting(state, name, value, &model); });
}

} // namespace

TEST_CASE("settings: what is kept is the same the next time") {
    SceneState state = freshState();
    const json changed = {{"exposure", -1.5},       {"tone", "aces"},         {"panels", false},
                          {"dark", false},          {"vsync", false},         {"coefficients", 77},
                          {"model-panel", true},    {"light-panel", false},   {"material-panel", false},
                          {"view-panel", true},     {"trust-panel", false},   {"background", "none"},
                          {"background-blur", 2.5}, {"ground-style", "fade"}, {"samples", 8}};
    const json before = rememberedSettings(state);
    for (const auto& [name, value] : changed.items()) {
        CAPTURE_BINDING(name);
        CHECK_NE(before.at(name), value);
        applySetting(state, name, value, nullptr);
    }
    const json kept = rememberedSettings(state);
    CHECK_EQ(kept, changed);
    SceneState next = freshState();
    for (const auto& [name, value] : kept.items()) applySetting(next, name, value, nullptr);
    CHECK_EQ(rememberedSettings(next), kept);
    CHECK_EQ(next.light.selection.count, 77);
    for (const auto& [name, value] : before.items()) applySetting(next, name, value, nullptr);
    CHECK_EQ(rememberedSettings(next), before);
}

TEST_CASE("settings: each changes what it is called after") {
    SceneState state = freshState();
    state.orbit = Orbit{};
    const Bounds model{vec3(-1), vec3(1)};
    const auto set = [&](const char* name, const json& value) { applySetting(state, name, value, &model); };
    set("exposure", 2);
    CHECK_EQ(state.exposure, 2);
    CHECK_FALSE(state.exposesItself);
    set("exposure", "auto");
    CHECK(state.exposesItself);
    CHECK(state.wantsExposure);
    set("background", "none");
    CHECK_EQ(state.background, BackgroundKind::None);
    set("background-blur", 3);
    CHECK_EQ(state.backgroundBlur, 3);
    set("ground-style", "fade");
    CHECK(state.ground == GroundStyle::Fade);
    set("rotation", 30);
    CHECK_EQ(state.light.rotation, 30);
    set("gain", 0.5);
    CHECK_EQ(state.light.environmentGain, 0.5f);
    set("seconds", 2.5);
    CHECK_EQ(state.light.seconds, 2.5);
    set("terms", 3);
    CHECK_EQ(state.terms, 3);
    set("split", 0.25);
    CHECK_EQ(state.split, 0.25f);
    set("compare", "difference");
    CHECK_EQ(state.compare, Compare::Difference);
    set("inspect", "density");
    CHECK_EQ(state.inspect, Inspect::Density);
    set("play", true);
    CHECK(state.light.plays);
    set("turntable", true);
    CHECK(state.turns);
    set("light-vector", true);
    CHECK(state.showsLight);
    set("help", true);
    CHECK(state.showsHelp);
    set("threshold", 64);
    CHECK_EQ(state.light.selection.threshold, 64);
    set("coefficients", 0); // by threshold still
    CHECK_EQ(state.light.selection.threshold, 64);
    set("coefficients", 9);
    CHECK_EQ(state.light.selection, LightSelection{.count = 9});
    set("material", "clay");
    CHECK_EQ(state.material.at(0).name, "clay");
    set("material", {{"clay", 0.25}, {"gold", 2}});
    REQUIRE_EQ(state.material.size(), 2u);
    CHECK_EQ(state.material[1].weight, 2);
    set("material", "");
    CHECK(state.material.empty());
    set("lamps", {{{"azimuth", 5}, {"color", {1, 0, 0.5}}}, json::object()});
    REQUIRE_EQ(state.light.lamps.size(), 2u);
    CHECK_EQ(state.light.lamps[0].azimuth, 5);
    CHECK_EQ(state.light.lamps[0].color, vec3(1, 0, 0.5f));
    CHECK_EQ(state.light.lamps[1], LampChoice{});
    set("strokes", {{{"elevation", 5}, {"radiance", {7, 0, 1}}, {"opacity", 0.5}}});
    CHECK_EQ(state.light.strokes.at(0), StrokeChoice{.elevation = 5, .radiance = {7, 0, 1}, .opacity = 0.5f});
    set("day-sky", {{"day", 12}, {"hour", 6.5}, {"latitude", -30}, {"turbidity", 5}});
    CHECK_EQ(state.light.sky, DaySkyChoice{12, 6.5f, -30, 5});
    CHECK(state.light.isDay());
    set("azimuth", 90);
    CHECK(state.orbit->azimuth == doctest::Approx(kPi / 2));
    set("elevation", -45);
    CHECK(state.orbit->elevation == doctest::Approx(-kPi / 4));
    set("distance", 2);
    CHECK(state.orbit->distance == doctest::Approx(2 * std::sqrt(3)));
    set("fov", 50);
    CHECK_EQ(state.fovDegrees, 50);
    CHECK_EQ(state.orbit->verticalFov, glm::radians(50.0f));
}

TEST_CASE("settings: say what they expected") {
    const std::tuple<const char*, json, const char*> wrong[] = {
        {"exposure", "dark", "\"exposure\": expected a number from -100 to 100, found \"dark\""},
        {"background", "sky", "\"background\": expected environment or none, found \"sky\""},
        {"background-blur", 91, "from 0 to 90, found 91"},
        {"exposure", 101, "from -100 to 100, found 101"},
        {"split", nullptr, "from 0 to 1, found null"},
        {"fov", 0, "from 1 to 170, found 0"},
        {"tone", "film", "\"tone\": expected none or aces or agx, found \"film\""},
        {"compare", true, "expected off or split or reference or difference, found true"},
        {"inspect", 1, "expected off or wireframe or normals or density"},
        {"dark", 1, "\"dark\": expected true or false, found 1"},
        {"coefficients", -1, "\"coefficients\": expected a number from 0 to 24576, found -1"},
        {"threshold", 40000, "\"threshold\": expected a number from 0 to 32767"},
        {"material", 3, "\"material\": expected a name, or weights by name, found 3"},
        {"material", {{"gold", -1}}, "\"gold\": expected a number from 0"},
        {"material", {{"gold", 0}, {"clay", 0}}, "\"material\": expected at least one weight above 0"},
        {"material", json::object(), "expected a name, or weights by name, found {}"},
        {"lamps", {{"azimuth", 3}}, "\"lamps\": expected a list of at most 512 objects"},
        {"lamps", json(std::vector<json>(513, json::object())), "at most 512"},
        {"lamps", {3}, "\"lamps\": expected an object, found 3"},
        {"lamps", {{{"size", 3}}}, "\"lamps\": there is no \"size\""},
        {"lamps", {{{"color", {1, 1}}}}, "\"color\": expected three numbers"},
        {"lamps", {{{"color", {1, 1, 2}}}}, "\"color\": expected a number from 0 to 1, found 2"},
        {"strokes", {{{"radius", 0}}}, "\"radius\": expected a number from 0.5 to 180, found 0"},
        {"strokes", {{{"brush", 0}}}, "\"strokes\": there is no \"brush\""},
        {"day-sky", {{"day", 366}}, "\"day\": expected a number from 1 to 365, found 366"},
        {"day-sky", {{"month", 1}}, "\"day-sky\": there is no \"month\""},
        {"day-sky", 5, "\"day-sky\": expected an object, found 5"},
        {"expsure", 5, "no setting is called \"expsure\"; did you mean \"exposure\"?"},
    };
    for (const auto& [name, value, words] : wrong) {
        const std::string failure = settingFailure(name, value);
        CAPTURE(failure);
        CAPTURE_BINDING(words);
        CHECK(says(failure, words));
    }
    SceneState state = freshState();
    CHECK_THROWS_WITH_AS(applySetting(state, "azimuth", 3, nullptr),
                         "\"azimuth\": nothing is shown yet; \"wait\" for it", Error);
}

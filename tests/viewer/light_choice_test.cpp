// The light that is chosen, and the file that says the same.
#include "apps/viewer/light_choice.h"
#include "engine/import/environment_file.h"

#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/light/sun_position.h"
#include "tests/support/capture_binding.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;
using SourceKind = EnvironmentChoice::Kind;

namespace {

struct Choices {
    TemporaryFolder folder;
    LightState state;

    Choices() {
        Image map(32, 16);
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 32; x++) map.at(x, y) = {0.1f * float(x % 7), 0.3f, 0.07f * float(y), 1};
        const std::filesystem::path file = folder.path() / "map.exr";
        writeExr(file, map);
        const auto prepared = [](const Environment& environment) {
            return std::make_shared<const Environment>(prepareForSampling(environment));
        };
        state.environments = {{SourceKind::BuiltIn, "sky", "", prepared(makeSky())},
                              {SourceKind::DaySky, "day sky"},
                              {SourceKind::File, "map", file, prepared(readEnvironment(file))}};
        state.environment = 2;
    }

    // What the file gives, and what is shown, have the same bits.
    void check() const {
        const nlohmann::ordered_json values = lightFileOf(state);
        CAPTURE(values.dump());
        const Light read = readLight(folder.write("chosen.light.json", values.dump(2))).at(0);
        const LightCube fromFile = sampleLight(read, 32), shown = sampleLight(lightOf(state), 32);
        CHECK(fromFile.radiance == shown.radiance);
        CHECK(std::ranges::any_of(shown.radiance, [](vec3 v) { return v.x + v.y + v.z > 0; }));
    }
};

} // namespace

TEST_CASE("light choice: its file is the same light, bit for bit") {
    Choices choices;
    LightState& state = choices.state;
    choices.check();
    state.environmentGain = 0.37f;
    choices.check();
    state.lamps = {{.azimuth = -33.3f, .elevation = 12.7f, .radius = 3.1f, .brightness = 0.9f},
                   {.azimuth = 100, .elevation = -80, .radius = 60, .color = {0, 1, 0.3f}}};
    choices.check();
    state.strokes = {{.azimuth = 1.1f, .elevation = 5, .radius = 33, .radiance = {2, 0, 1}, .opacity = 0.7f},
                     {.azimuth = 200, .elevation = 60, .radius = 170}};
    choices.check();
    state.environmentGain = 0; // lamps and strokes alone
    choices.check();
    state.environment = 0;
    choices.check();
    state.environment = 1;
    state.environmentGain = 1.3f;
    state.sky = {.dayOfYear = 31, .hour = 8.1f, .latitude = -12.3f, .turbidity = 3.3f};
    choices.check();
    state.strokes.clear();
    state.lamps.clear();
    choices.check();
}

TEST_CASE("light choice: what a file says can be chosen again") {
    Choices choices;
    LightState& state = choices.state;
    const auto checkAgain = [&] {
        const nlohmann::json written = nlohmann::json::parse(lightFileOf(state).dump());
        CAPTURE(written.dump());
        LightState again;
        again.environments = {state.environments[0],
                              {.kind = EnvironmentChoice::Kind::DaySky, .name = "day sky"}};
        setLight(again, written, "test", choices.folder.path());
        CHECK_EQ(again.chosen().kind, state.chosen().kind);
        CHECK_EQ(again.chosen().file, state.chosen().file);
        CHECK_EQ(again.environmentGain, state.environmentGain);
        CHECK(again.strokes == state.strokes);
        CHECK(again.sky.dayOfYear == state.sky.dayOfYear);
        CHECK(again.sky.hour == doctest::Approx(state.sky.hour).epsilon(1e-5));
        REQUIRE_EQ(again.lamps.size(), state.lamps.size());
        for (size_t i = 0; i < state.lamps.size(); i++) {
            CHECK(again.lamps[i].brightness == doctest::Approx(state.lamps[i].brightness));
            CHECK(glm::distance(again.lamps[i].color, state.lamps[i].color) < 1e-6f);
        }
    };
    checkAgain();
    state.environment = 0; // the built-in sky
    state.lamps = {
        {.azimuth = -33.3f, .elevation = 12.7f, .radius = 3.1f, .color = {1, 0.5f, 0}, .brightness = 2}};
    state.strokes = {{.azimuth = 1.1f, .elevation = 5, .radius = 33, .radiance = {2, 0, 1}, .opacity = 0.7f}};
    checkAgain();
    state.environment = 1;
    state.sky = {.dayOfYear = 366 - 31, .hour = 8.1f, .latitude = -12.3f, .turbidity = 3.3f};
    REQUIRE(state.isDay());
    checkAgain();
    LightState before = state;
    for (const char* wrong :
         {R"({"lamps": [{"azimuth": 1, "elevation": 2, "radius": 0, "radiance": [1, 1, 1]}]})",
          R"({"distant": []})", R"({"sky": {"time": "noon", "latitude": 0, "longitude": 0}})"}) {
        CHECK_THROWS(setLight(state, nlohmann::json::parse(wrong), "test", ""));
        CHECK(lightsAlike(state, before));
    }
}

TEST_CASE("light choice: a brush that moves fast leaves no gaps, and one that rests no strokes") {
    const StrokeChoice last{170, 10, 15, vec3(2), 0.5f}, next{-130, -20, 10, vec3(1), 1};
    const std::vector<StrokeChoice> strokes = strokesTo(last, next); // across the map's edge
    REQUIRE(strokes.size() > 10);
    CHECK(strokes.back() == next);
    StrokeChoice before = last;
    for (const StrokeChoice& stroke : strokes) {
        CHECK(glm::dot(directionAt(before.azimuth, before.elevation),
                       directionAt(stroke.azimuth, stroke.elevation)) > std::cos(glm::radians(6.0f)));
        CHECK(stroke.elevation < before.elevation);
        CHECK(std::abs(stroke.azimuth) > 129);
        CHECK(stroke.radius == next.radius);
        before = stroke;
    }
    CHECK(strokesTo(next, {-129, -20, 10, vec3(1), 1}).empty());
    CHECK(strokesTo(next, {-125, -20, 10, vec3(1), 1}).size() == 1);
}

TEST_CASE("light choice: a lamp lights white that faces it to its brightness") {
    Choices choices;
    choices.state.environmentGain = 0;
    for (const float radius : {2.0f, 20.0f, 60.0f}) {
        choices.state.lamps = {
            {.azimuth = 0, .elevation = 0, .radius = radius, .color = vec3(1), .brightness = 1.5f}};
        const Light light = lightOf(choices.state);
        const float sine = std::sin(glm::radians(radius));
        CHECK(light.lamps[0].radiance.x * sine * sine == doctest::Approx(1.5));
    }
}

TEST_CASE("light choice: the sun is where clock and place put it") {
    const SunPlace noon = sunPlaceOf({.dayOfYear = 80, .hour = 12, .latitude = 48}); // an equinox
    CHECK(noon.elevation == doctest::Approx(42).epsilon(0.03));
    CHECK(std::abs(noon.azimuth) < 5); // the south is +Z
    const SunPlace morning = sunPlaceOf({.dayOfYear = 80, .hour = 8, .latitude = 48}),
                   evening = sunPlaceOf({.dayOfYear = 80, .hour = 16, .latitude = 48});
    CHECK_GT(directionAt(morning.azimuth, morning.elevation).x, 0.5f); // the east is +X
    CHECK_LT(directionAt(evening.azimuth, evening.elevation).x, -0.5f);
    CHECK_LT(sunPlaceOf({.dayOfYear = 80, .hour = 0, .latitude = 48}).elevation, -30);
    CHECK_GT(sunPlaceOf({.dayOfYear = 172, .hour = 0, .latitude = 80}).elevation, 0); // midnight sun
    // As light files have it.
    for (const auto& [day, date] : {std::pair(1, "2026-01-01"),
                                    {31, "2026-01-31"},
                                    {32, "2026-02-01"},
                                    {60, "2026-03-01"},
                                    {172, "2026-06-21"},
                                    {365, "2026-12-31"}}) {
        CAPTURE_BINDING(date);
        const SunPosition sun = sunPosition(parseMoment(std::string(date) + "T09:30:00Z"), 48, 0);
        const SunPlace place = sunPlaceOf({.dayOfYear = day, .hour = 9.5f, .latitude = 48});
        CHECK(place.elevation == doctest::Approx(sun.elevation).epsilon(1e-5));
        CHECK(place.azimuth == doctest::Approx(180 - sun.azimuth).epsilon(1e-5));
    }
}

TEST_CASE("light choice: what plays is the file's time, the day, or a turn") {
    Choices choices;
    LightState& state = choices.state;
    play(state, 2);
    CHECK(state.rotation == doctest::Approx(40));
    play(state, 8);
    CHECK(state.rotation == doctest::Approx(-160));
    state.environment = 1;
    state.sky.hour = 23.5f;
    play(state, 2);
    CHECK(state.sky.hour == doctest::Approx(0.5));
    CHECK(state.rotation == doctest::Approx(-160));
    const auto fileOf = [](const char* text) { return std::make_shared<MovingLight>(text, "light", "."); };
    state.file = fileOf(R"({"lamps": [{"azimuth": {"keys": [[0, 0], [4, 90]]}, "elevation": 0, "radius": 5,
                                       "radiance": [1, 1, 1]}]})");
    play(state, 1.5);
    CHECK(state.seconds == doctest::Approx(1.5));
    CHECK(state.sky.hour == doctest::Approx(0.5));
    state.file = fileOf(R"({"lamps": [{"azimuth": 0, "elevation": 0, "radius": 5, "radiance": [1, 1, 1]}]})");
    play(state, 1); // which does not move: a turn
    CHECK(state.seconds == doctest::Approx(1.5));
    CHECK(state.rotation == doctest::Approx(-140));
}

#include "engine/base/error.h"
#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/light/sun_position.h"
#include "tests/support/failure.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <limits>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

std::string lightFailure(const std::string& text) {
    const TemporaryFolder folder;
    return failureOf([&] { readLight(folder.write("light.json", text)); });
}

} // namespace

TEST_CASE("light file: everything that the format has") {
    const TemporaryFolder folder;
    Image image(8, 4);
    for (vec4& pixel : image.pixels) pixel = vec4(1, 2, 3, 1);
    writeExr(folder.path() / "a.exr", image);
    MovingLight file = readLight(folder.write("light.json", R"({
        "environment": {"file": "a.exr", "rotate": 90, "gain": 2},
        "blend": {"file": "a.exr", "weight": 0.25},
        "sky": {"time": "2026-06-21T12:00:00+02:00", "latitude": 48, "longitude": 11, "north": 90, "turbidity": 4,
                "ground": [0.1, 0.2, 0.3], "gain": 0.5, "disc": false},
        "strokes": [{"azimuth": 90, "elevation": 0, "radius": 20, "radiance": [1, 2, 3], "softness": 0.25,
                     "opacity": 0.75}],
        "lamps": [{"azimuth": 0, "elevation": 90, "radius": 1, "radiance": [4, 5, 6]},
                  {"azimuth": 0, "elevation": 0, "radius": 180, "radiance": [0, 0, 0]}],
        "distant": [{"azimuth": 180, "elevation": 30, "irradiance": [7, 8, 9]}]
    })"));
    CHECK_FALSE(file.moves());
    const Light light = file.at(0);
    REQUIRE(light.environments.size() == 2);
    CHECK(light.environments[0].gain == 1.5f);
    CHECK(light.environments[0].rotation == doctest::Approx(kPi / 2));
    CHECK(light.environments[1].gain == 0.25f);
    CHECK(glm::distance(light.environments[0].map->radiance[5], vec3(1, 2, 3)) < 1e-5f);
    REQUIRE(light.sky);
    // A little before noon, so east of south; here the compass's north is the world's +X, south -X, east +Z.
    const SunPosition sun = sunPosition(parseMoment("2026-06-21T10:00Z"), 48, 11);
    CHECK(light.sky->sun.y == doctest::Approx(std::sin(glm::radians(sun.elevation))));
    CHECK(light.sky->sun.x < -0.2f);
    CHECK(light.sky->sun.z > 0.1f);
    CHECK(light.sky->turbidity == 4);
    CHECK(light.sky->ground == vec3(0.1f, 0.2f, 0.3f));
    CHECK_FALSE(light.sky->hasDisc);
    REQUIRE(light.strokes.size() == 1);
    CHECK(glm::distance(light.strokes[0].direction, vec3(1, 0, 0)) < 1e-6f);
    CHECK(light.strokes[0].angularRadius == doctest::Approx(kPi / 9));
    CHECK(light.strokes[0].softness == 0.25f);
    CHECK(light.strokes[0].opacity == 0.75f);
    REQUIRE(light.lamps.size() == 2);
    CHECK(glm::distance(light.lamps[0].direction, vec3(0, 1, 0)) < 1e-6f);
    CHECK(light.lamps[1].angularRadius == kPi);
    REQUIRE(light.distant.size() == 1);
    CHECK(light.distant[0].irradiance == vec3(7, 8, 9));
    CHECK_NOTHROW(sampleLight(light, 16));
}

TEST_CASE("light file: a sky by its sun, and nothing at all") {
    const TemporaryFolder folder;
    const Light light =
        readLight(folder.write("light.json", R"({"sky": {"sun": {"azimuth": 90, "elevation": 30}}})")).at(0);
    CHECK(glm::distance(light.sky->sun, vec3(std::sqrt(0.75f), 0.5f, 0)) < 1e-6f);
    CHECK(light.sky->hasDisc);
    for (const vec3& radiance : sampleLight(readLight(folder.write("dark.json", "{}")).at(0), 16).radiance)
        CHECK(radiance == vec3(0));
}

TEST_CASE("light file: errors name file, place and field") {
    const auto check = [](const std::string& text, std::initializer_list<const char*> parts) {
        const std::string failure = lightFailure(text);
        CAPTURE(text);
        CAPTURE(failure);
        CHECK(failure.find("light.json") != std::string::npos);
        for (const char* part : parts) CHECK(failure.find(part) != std::string::npos);
    };
    check("[", {"JSON"});
    check("[]", {"object"});
    check(R"({"lamp": []})", {"\"lamp\"", "did you mean \"lamps\""});
    check(R"({"lamps": {}})", {"\"lamps\"", "list"});
    check(R"({"lamps": [{}]})", {"lamps[0]", "\"azimuth\"", "nothing"});
    check(R"({"lamps": [{"azimuth": 0, "elevation": 0, "radius": 0, "radiance": [1, 1, 1]}]})",
          {"\"radius\""});
    check(R"({"lamps": [{"azimuth": 0, "elevation": 0, "radius": 1, "radiance": [1, -1, 1]}]})",
          {"\"radiance\""});
    check(R"({"lamps": [{"azimuth": 0, "elevation": 0, "radius": 1, "radiance": [1, 1]}]})",
          {"three numbers"});
    check(R"({"strokes": [{"azimuth": 0, "elevation": 91, "radius": 1, "radiance": [1, 1, 1]}]})",
          {"strokes[0]", "\"elevation\"", "91"});
    check(R"({"distant": [{"azimuth": 1e99, "elevation": 0, "irradiance": [1, 1, 1]}]})", {"\"azimuth\""});
    check(R"({"blend": {"file": "a.exr", "weight": 0.5}})", {"\"environment\"", "blend"});
    check(R"({"environment": {"flie": "a.exr"}})", {"environment", "did you mean \"file\""});
    check(R"({"sky": {}})", {"sky", "\"sun\"", "latitude"});
    check(R"({"sky": {"sun": {"azimuth": 0, "elevation": 0}, "time": "2026-06-21T12:00Z"}})", {"\"sun\""});
    check(R"({"sky": {"sun": {"azimuth": 0, "elevation": 0}, "latitude": 3}})",
          {"\"latitude\"", "beside \"sun\""});
    check(R"({"sky": {"time": "noon", "latitude": 3, "longitude": 4}})",
          {"\"time\"", "noon", "2026-06-21T14:30"});
    check(R"({"sky": {"time": "2026-06-21T12:00Z", "latitude": 3}})", {"\"longitude\""});
    check(R"({"sky": {"sun": {"azimuth": 0, "elevation": 0}, "turbidity": 1}})",
          {"\"turbidity\"", "2 to 10"});
    check(R"({"sky": {"sun": {"azimuth": 0, "elevation": 0}, "disc": 1}})", {"\"disc\"", "true or false"});
    check(R"({"sky": {"sun": {"azimuth": 0, "elevation": 0}, "hours_per_second": 1}})",
          {"\"hours_per_second\"", "beside \"sun\""});
    check(R"({"environment": {"file": "a.exr", "sequence": "#.exr"}})", {"environment", "\"sequence\""});
    check(R"({"environment": {"file": "a.exr", "rate": 3}})", {"environment", "\"rate\""});
    check(R"({"environment": {}})", {"environment", "\"file\"", "found nothing"});
    const std::string lamp = R"({"lamps": [{"azimuth": 0, "elevation": 0, "radius": 1)";
    check(lamp + "}]}", {"lamps[0]", "\"radiance\"", "found nothing"});
    check(lamp + R"(, "radiance": {"a": 1, "b": 2, "c": 3}}]})", {"\"radiance\"", "three numbers"});
    for (const char* keys : {"[[]]", "[[0, 1, 2]]", R"([{"a": 1, "b": 2}])", "[5]"})
        check(R"({"distant": [{"azimuth": {"keys": )" + std::string(keys) +
                  R"(}, "elevation": 0, "irradiance": [1, 1, 1]}]})",
              {"azimuth", "keys [seconds, value]"});
    check(R"({"distant": [{"azimuth": {"keys": [[-0.5, 1]]}, "elevation": 0, "irradiance": [1, 1, 1]}]})",
          {"azimuth", "rising times from 0"});
    const TemporaryFolder folder;
    for (const char* name : {"q1.exr", "q2.exr"}) writeExr(folder.path() / name, Image(4, 2));
    for (const char* rate : {"-1000000", "-1", "0", "1001"}) {
        const std::string text =
            R"({"environment": {"sequence": "q#.exr", "rate": )" + std::string(rate) + "}}";
        CHECK(says(failureOf([&] { readLight(folder.write("light.json", text)); }),
                   "\"rate\": expected numbers from 0.001 to 1000"));
    }
    std::string many = R"({"distant": [)";
    for (int i = 0; i <= 512; i++) many += i ? ",{}" : "{}";
    check(many + "]}", {"at most 512"});
    // Of other files, that file.
    const auto names = [](const char* text, const char* part) {
        return lightFailure(text).find(part) != std::string::npos;
    };
    CHECK(names(R"({"environment": {"file": "none.exr"}})", "none.exr"));
    CHECK(names(R"({"environment": {"sequence": "a_##.exr"}})", "a_##.exr: expected files with a number"));
    CHECK(names(R"({"environment": {"sequence": "a.exr"}})", "a.exr: expected one run of #"));
}

TEST_CASE("light file: every number has a range, and the ends are within it") {
    const TemporaryFolder folder;
    for (const char* name : {"a.exr", "q1.exr", "q2.exr"}) writeExr(folder.path() / name, Image(4, 2));
    const nlohmann::json light = nlohmann::json::parse(R"({
        "environment": {"file": "a.exr", "rotate": 90, "gain": 2},
        "blend": {"sequence": "q#.exr", "rotate": 90, "gain": 2, "weight": 0.25},
        "strokes": [{"azimuth": 90, "elevation": 0, "radius": 20, "radiance": [1, 2, 3], "softness": 0.25,
                     "opacity": 0.75}],
        "lamps": [{"azimuth": 0, "elevation": 90, "radius": 1, "radiance": [4, 5, 6]}],
        "distant": [{"azimuth": 180, "elevation": 30, "irradiance": [7, 8, 9]}]
    })");
    nlohmann::json clock = light, sun = light;
    clock["sky"] = {{"time", "2026-06-21T12:00Z"},
                    {"latitude", 48},
                    {"longitude", 11},
                    {"north", 90},
                    {"hours_per_second", 1}};
    sun["sky"] = {{"sun", {{"azimuth", 90}, {"elevation", 30}}},
                  {"turbidity", 4},
                  {"gain", 1},
                  {"ground", {0, 0.5, 1}}};
    struct Range {
        const nlohmann::json& light;
        const char* place;
        float low, high;
    };
    constexpr float kTurns = 36000;
    for (const Range& range :
         std::initializer_list<Range>{{light, "/environment/rotate", -kTurns, kTurns},
                                      {light, "/environment/gain", 0, kMostGain},
                                      {light, "/blend/rotate", -kTurns, kTurns},
                                      {light, "/blend/gain", 0, kMostGain},
                                      {light, "/blend/weight", 0, 1},
                                      {light, "/strokes/0/azimuth", -kTurns, kTurns},
                                      {light, "/strokes/0/elevation", -90, 90},
                                      {light, "/strokes/0/radius", kSmallestLampRadius, 180},
                                      {light, "/strokes/0/radiance/0", 0, kMostRadiance},
                                      {light, "/strokes/0/softness", 0, 1},
                                      {light, "/strokes/0/opacity", 0, 1},
                                      {light, "/lamps/0/azimuth", -kTurns, kTurns},
                                      {light, "/lamps/0/elevation", -90, 90},
                                      {light, "/lamps/0/radius", kSmallestLampRadius, 180},
                                      {light, "/lamps/0/radiance/1", 0, kMostRadiance},
                                      {light, "/distant/0/azimuth", -kTurns, kTurns},
                                      {light, "/distant/0/elevation", -90, 90},
                                      {light, "/distant/0/irradiance/2", 0, kMostRadiance},
                                      {clock, "/sky/latitude", -90, 90},
                                      {clock, "/sky/longitude", -180, 180},
                                      {clock, "/sky/north", -kTurns, kTurns},
                                      {clock, "/sky/hours_per_second", -100, 100},
                                      {sun, "/sky/sun/azimuth", -kTurns, kTurns},
                                      {sun, "/sky/sun/elevation", -90, 90},
                                      {sun, "/sky/turbidity", 2, 10},
                                      {sun, "/sky/ground/0", 0, 1},
                                      {sun, "/sky/gain", 0, kMostGain}}) {
        const auto failureAt = [&](float value) {
            nlohmann::json changed = range.light;
            changed[nlohmann::json::json_pointer(range.place)] = value;
            const auto path = folder.write("light.json", changed.dump());
            return failureOf([&] { readLight(path).at(0); });
        };
        CAPTURE(range.place);
        for (const float end : {range.low, range.high}) CHECK_EQ(failureAt(end), "");
        constexpr float kFar = std::numeric_limits<float>::max();
        for (const float beyond : {std::nextafter(range.low, -kFar), std::nextafter(range.high, kFar)})
            CHECK(says(failureAt(beyond),
                       fmt::format("expected numbers from {:g} to {:g}", range.low, range.high)));
    }
}

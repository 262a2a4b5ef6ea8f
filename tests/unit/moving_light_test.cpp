#include "engine/base/error.h"
#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/light/sun_position.h"
#include "tests/support/failure.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <fmt/core.h>

using namespace relume;
using namespace relume::test;

namespace {

MovingLight lightOf(const std::string& text) {
    const TemporaryFolder folder;
    return readLight(folder.write("light.json", text));
}

MovingLight lampOf(const std::string& radius) {
    return lightOf(R"({"lamps": [{"azimuth": 0, "elevation": 0, "radiance": [1, 1, 1], "radius": )" + radius +
                   "}]}");
}

std::string lampFailure(const std::string& radius) {
    return failureOf([&] { lampOf(radius); });
}

double degrees(float angle) { return double(glm::degrees(angle)); }

void writeMap(const std::filesystem::path& path, float value) {
    Image image(8, 4);
    for (vec4& pixel : image.pixels) pixel = vec4(value, value, value, 1);
    writeExr(path, image);
}

// The radiance of an environment whose maps are each of one.
float radianceOf(const Light& light) {
    float sum = 0;
    for (const EnvironmentLight& environment : light.environments)
        sum += environment.gain * environment.map->radiance[5].x;
    return sum;
}

} // namespace

TEST_CASE("moving light: tracks change evenly between their keys and stay outside") {
    MovingLight light = lampOf(R"({"keys": [[1, 10], [3, 20], [4, 40]]})");
    CHECK(light.moves());
    for (const auto& [seconds, radius] : std::vector<std::pair<double, double>>{
             {0, 10}, {1, 10}, {2, 15}, {3, 20}, {3.25, 25}, {4, 40}, {1000, 40}})
        CHECK(degrees(light.at(seconds).lamps[0].angularRadius) == doctest::Approx(radius));

    MovingLight repeated = lampOf(R"({"keys": [[0, 10], [2, 20]], "repeat": true})");
    for (const auto& [seconds, radius] :
         std::vector<std::pair<double, double>>{{0, 10}, {1, 15}, {1.999, 19.995}, {2, 10}, {7, 15}})
        CHECK(degrees(repeated.at(seconds).lamps[0].angularRadius) == doctest::Approx(radius));

    CHECK_FALSE(lampOf(R"({"keys": [[0, 10]]})").moves());
}

TEST_CASE("moving light: colors are tracks too, and a gain is of all") {
    MovingLight light = lightOf(
        R"({"distant": [{"azimuth": 0, "elevation": 0, "irradiance": {"keys": [[0, [1, 2, 3]], [1, [3, 2, 1]]]}}]})");
    light.setGain(2);
    CHECK(light.at(0.5).distant[0].irradiance == vec3(4));
}

TEST_CASE("moving light: what is wrong at any time is found when it is read") {
    const auto check = [](const std::string& radius, std::initializer_list<const char*> parts) {
        const std::string failure = lampFailure(radius);
        CAPTURE(failure);
        for (const char* part : parts) CHECK(failure.find(part) != std::string::npos);
    };
    check(R"({"keys": [[0, 10], [1, 20], [2, 200]]})", {"light.json", "lamps[0]", "\"radius\"", "200"});
    check(R"({"keys": []})", {"light.json", "lamps", "radius", "1 to 4096"});
    check(R"({"keys": [[0, 10]], "loop": true})", {"\"loop\""});
    check(R"({"keys": [[0, 10]], "repeat": 1})", {"true or false"});
    check(R"({"keys": [[1, 10], [1, 20]]})", {"rising", "1 after 1"});
    check(R"({"keys": [[-1, 10]]})", {"rising"});
    check(R"({"keys": [[0, 10], [1, [1, 2, 3]]]})", {"all of"});
    check(R"({"keys": [[0, "10"]]})", {"[seconds, value]"});
    check(R"({"keys": [[0, [1, 2, 3]]]})", {"\"radius\""});
    std::string many = R"({"keys": [)";
    for (int i = 0; i <= 4096; i++) many += fmt::format("{}[{}, 1]", i ? "," : "", i);
    check(many + "]}", {"1 to 4096"});
    std::string deep(100000, '[');
    CHECK_THROWS_AS(lampOf(deep + std::string(100000, ']')), Error);
}

TEST_CASE("moving light: speeds that change add up") {
    const auto sunAt = [](const char* moment) {
        return std::sin(glm::radians(sunPosition(parseMoment(moment), 48, 11).elevation));
    };
    const auto sky = [](const std::string& speed) {
        return lightOf(R"({"sky": {"time": "2026-06-21T12:00Z", "latitude": 48, "longitude": 11,
                                   "hours_per_second": )" +
                       speed + "}}");
    };
    // 2 hours a second, slowing down from 1 s to a stand at 3 s: 2 h, then 2 h more.
    MovingLight slowing = sky(R"({"keys": [[1, 2], [3, 0]]})");
    for (const auto& [seconds, moment] :
         std::vector<std::pair<double, const char*>>{{0, "2026-06-21T12:00Z"},
                                                     {1, "2026-06-21T14:00Z"},
                                                     {2, "2026-06-21T15:30Z"},
                                                     {3, "2026-06-21T16:00Z"},
                                                     {9, "2026-06-21T16:00Z"}})
        CHECK(double(slowing.at(seconds).sky->sun.y) == doctest::Approx(sunAt(moment)).epsilon(1e-4));
    // Half an hour in every second.
    MovingLight pulsing = sky(R"({"keys": [[0, 0], [1, 1]], "repeat": true})");
    CHECK(double(pulsing.at(4).sky->sun.y) == doctest::Approx(sunAt("2026-06-21T14:00Z")).epsilon(1e-4));
    CHECK(double(pulsing.at(4.5).sky->sun.y) == doctest::Approx(sunAt("2026-06-21T14:07:30Z")).epsilon(1e-4));
}

TEST_CASE("moving light: the sky's hours pass") {
    MovingLight light = lightOf(
        R"({"sky": {"time": "2026-06-21T12:00Z", "latitude": 48, "longitude": 11, "hours_per_second": 2}})");
    CHECK(light.moves());
    const SunPosition sun = sunPosition(parseMoment("2026-06-21T15:00Z"), 48, 11);
    CHECK(double(light.at(1.5).sky->sun.y) == doctest::Approx(std::sin(glm::radians(sun.elevation))));
    CHECK_NOTHROW(light.at(30)); // past midnight
}

TEST_CASE("moving light: sequences go from file to file in the order of their numbers") {
    const TemporaryFolder folder;
    writeMap(folder.path() / "a_9.exr", 1);
    writeMap(folder.path() / "a_10.exr", 3);
    writeMap(folder.path() / "a_0011.exr", 7);
    writeMap(folder.path() / "a_x.exr", 100);
    writeMap(folder.path() / "a_.exr", 100);
    MovingLight light =
        readLight(folder.write("light.json", R"({"environment": {"sequence": "a_####.exr", "rate": 2}})"));
    CHECK(light.moves());
    for (const auto& [seconds, radiance] :
         std::vector<std::pair<double, float>>{{0, 1}, {0.25, 2}, {0.5, 3}, {0.75, 5}, {1, 7}, {9, 7}})
        CHECK(radianceOf(light.at(seconds)) == doctest::Approx(radiance));
    MovingLight slowing = readLight(folder.write(
        "slowing.json",
        R"({"environment": {"sequence": "a_#.exr", "rate": {"keys": [[0, 2], [0.5, 2], [1, 0.001]]}}})"));
    for (const auto& [seconds, radiance] :
         std::vector<std::pair<double, float>>{{0, 1}, {0.25, 2}, {0.5, 3}, {1, 5}, {1.5, 5}})
        CHECK(radianceOf(slowing.at(seconds)) == doctest::Approx(radiance).epsilon(0.01));
    // A map that is shown again is not read again.
    CHECK(light.at(0).environments[0].map == light.at(0.25).environments[0].map);

    writeMap(folder.path() / "a_09.exr", 1);
    CHECK_THROWS_AS(readLight(folder.write("light.json", R"({"environment": {"sequence": "a_####.exr"}})")),
                    Error);
}

TEST_CASE("moving light: a sequence's numbers may be long") {
    const TemporaryFolder folder;
    writeMap(folder.path() / "a_20261121120001.exr", 2);
    writeMap(folder.path() / "a_20261121120000.exr", 1);
    writeMap(folder.path() / "a_00000000000000000000000000000007.exr", 9);
    writeMap(folder.path() / "a_000.exr", 8);
    EnvironmentFiles files;
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files.sequence(folder.path() / "a_#.exr"))
        names.push_back(file.filename());
    CHECK(names == std::vector<std::string>{"a_000.exr", "a_00000000000000000000000000000007.exr",
                                            "a_20261121120000.exr", "a_20261121120001.exr"});
    CHECK_EQ(files.named().size(), 4);
}

TEST_CASE("moving light: a # in a folder's name, or in that of a file, makes no sequence") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "C#");
    writeMap(folder.path() / "C#/forest.exr", 1);
    writeMap(folder.path() / "take#3.exr", 1);
    CHECK_FALSE(isSequence(folder.path() / "C#/forest.exr"));
    CHECK_FALSE(isSequence(folder.path() / "take#3.exr"));
    CHECK(isSequence(folder.path() / "C#/forest_#.exr"));
    CHECK_FALSE(isSequence(""));
}

TEST_CASE("moving light: many keys of many lamps are read in a moment") {
    std::string track = R"({"keys": [[0, 1])";
    for (int i = 1; i < 4096; i++) track += fmt::format(",[{},{}]", i, 1 + i % 7);
    track += "]}";
    std::string lamps;
    for (int i = 0; i < 30; i++)
        lamps += fmt::format(R"({}{{"azimuth": {}, "elevation": {}, "radius": {}, "radiance": [1, 1, 1]}})",
                             i ? "," : "", track, track, track);
    MovingLight light = lightOf(fmt::format(R"({{"lamps": [{}]}})", lamps));
    CHECK(degrees(light.at(4.5).lamps[29].angularRadius) == doctest::Approx(5.5));
}

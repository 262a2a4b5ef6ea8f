// Images of light that moves.
#include "engine/import/image_file.h"
#include "tests/support/run_relume.h"
#include "tests/support/validation.h"

#include <doctest/doctest.h>
#include <fmt/core.h>

using namespace relume;
using namespace relume::test;

namespace {

constexpr const char* kLight = R"({
    "environment": {"sequence": "map_#.exr", "rate": 2, "gain": 0.5},
    "lamps": [{"azimuth": {"keys": [[0, 0], [2, 180]]}, "elevation": 40, "radius": 5, "radiance": [60, 50, 40]}]
})";

void prepare(const TemporaryFolder& folder, const std::string& layout) {
    for (int i = 0; i < 3; i++) {
        Image map(8, 4);
        for (vec4& pixel : map.pixels) pixel = vec4(1 + i, 2, 3 - i, 1);
        writeExr(folder.path() / fmt::format("map_{}.exr", i), map);
    }
    folder.write("light.json", kLight);
    REQUIRE_EQ(runRelume(folder, "bake " + ballIn(folder) +
                                     " -K 2 -N 32 --bounces 0 --visibility-size 64 --face-size 32 "
                                     "--map-size 16 -q -o rows.relume")
                   .exitCode,
               0);
    REQUIRE_EQ(runRelume(folder, "convert rows.relume -o a.relume --layout " + layout).exitCode, 0);
}

std::string frames(const TemporaryFolder& folder, const std::string& name, const std::string& options) {
    const Outcome outcome = runRelume(folder, "render a.relume -o " + name +
                                                  ".exr --size 64x48 --light light.json --frames 5 "
                                                  "--rate 4 --validation " +
                                                  relume::testValidation() + " " + options);
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    std::string all;
    for (int frame = 1; frame <= 5; frame++)
        all += contents(folder.path() / fmt::format("{}_{:04}.exr", name, frame));
    return all;
}

} // namespace

TEST_CASE("cli: moving light gives the same images however it is relit") {
    for (const char* layout : {"bases", "rows"}) {
        const TemporaryFolder folder;
        prepare(folder, layout);
        const std::string full = frames(folder, "full", "--turn both --relight full");
        CHECK(full == frames(folder, "changes", "--turn both --relight incremental"));
        CHECK(full == frames(folder, "auto", "--turn both"));
    }
}

TEST_CASE("cli: a moment of moving light is the same as a frame and alone") {
    const TemporaryFolder folder;
    prepare(folder, "bases");
    frames(folder, "f", "--turn none");
    const auto frame = [&](int number) {
        return contents(folder.path() / fmt::format("f_{:04}.exr", number));
    };
    CHECK(frame(1) != frame(2));
    REQUIRE_EQ(runRelume(folder, "render a.relume -o alone.exr --size 64x48 --light light.json --time 0.75")
                   .exitCode,
               0);
    CHECK(contents(folder.path() / "alone.exr") == frame(4));
    // A sequence without a light file, and what is wrong with one.
    CHECK_EQ(runRelume(folder, "render a.relume -o s.exr --size 64x48 -e map_#.exr --frames 2").exitCode, 0);
    CHECK(contents(folder.path() / "s_0001.exr") != contents(folder.path() / "s_0002.exr"));
    // What is read is not written over.
    const std::string map = contents(folder.path() / "map_1.exr");
    std::filesystem::rename(folder.path() / "map_1.exr", folder.path() / "map_0001.exr");
    std::filesystem::create_directory(folder.path() / "C#");
    std::filesystem::copy_file(folder.path() / "map_0.exr", folder.path() / "C#/map.exr");
    folder.write("still.json", R"({"environment": {"file": "map_0.exr"}})");
    for (const char* options :
         {"-e map_####.exr -o map.exr --frames 2", "-e map_#.exr -o map_0001.exr",
          "-e map_0.exr -o map_0.exr", "-e map_0.exr --blend map_0001.exr -o ./map_0001.exr",
          "--light light.json -o map.exr --frames 2", "--light still.json -o map_0.exr",
          "--light light.json -o s.exr --timings light.json"}) {
        CAPTURE(options);
        const Outcome outcome = runRelume(folder, std::string("render a.relume --size 64x48 ") + options);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, "written over"));
    }
    CHECK_EQ(runRelume(folder, "reference a.relume -e map_#.exr -o map_0001.exr").exitCode, 2);
    CHECK(contents(folder.path() / "map_0001.exr") == map);
    CHECK(contents(folder.path() / "light.json") == kLight);
    CHECK_EQ(runRelume(folder, "render a.relume -o s.exr --size 64x48 -e 'C#/map.exr'").exitCode, 0);
    const Outcome none = runRelume(folder, "render a.relume -o s.exr -e none_##.exr");
    CHECK_EQ(none.exitCode, 1);
    CHECK(says(none.err, "none_##.exr"));
}

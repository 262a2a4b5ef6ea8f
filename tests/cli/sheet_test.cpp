// A contact sheet: every material of bakes under several lights.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>

using namespace relume::test;

namespace {

// The size that a PNG file's header tells.
std::pair<uint32_t, uint32_t> sizeOfPng(const std::string& bytes) {
    REQUIRE(bytes.size() > 24);
    const auto word = [&](size_t at) {
        uint32_t value = 0;
        for (size_t i = at; i < at + 4; i++) value = value << 8 | uint8_t(bytes[i]);
        return value;
    };
    return {word(16), word(20)};
}

} // namespace

TEST_CASE("sheet: a row for each material, a column for each light") {
    const TemporaryFolder folder;
    const std::string small =
        " -K 2 -N 32 --bounces 0 --visibility-size 64 --face-size 32 --map-size 16 -q -o ";
    REQUIRE_EQ(
        runRelume(folder, "bake " + ballIn(folder) + " -m clay -m gold" + small + "two.relume").exitCode, 0);
    REQUIRE_EQ(runRelume(folder, "bake " + ballIn(folder) + " -m chrome" + small + "one.relume").exitCode, 0);
    folder.write("sun.json", R"({"distant": [{"azimuth": 30, "elevation": 40, "irradiance": [3, 3, 3]}]})");
    folder.write("lamp.json",
                 R"({"lamps": [{"azimuth": 30, "elevation": 40, "radius": 5, "radiance": [90, 80, 70]}]})");
    const Outcome sheet =
        runRelume(folder, "sheet two.relume one.relume -e sun.json -e lamp.json --size 40x30 -o sheet.png");
    REQUIRE_MESSAGE(sheet.exitCode == 0, sheet.err);
    CHECK(sizeOfPng(contents(folder.path() / "sheet.png")) == std::pair<uint32_t, uint32_t>(84, 98));
    for (const char* row : {"row 1: two", "row 2: two, gold", "row 3: one", "column 2: lamp.json"})
        CHECK_MESSAGE(says(sheet.err, row), sheet.err);
    const Outcome large = runRelume(folder, "sheet one.relume --size 16000x16000 -o large.png");
    CHECK_EQ(large.exitCode, 2);
    CHECK_MESSAGE(says(large.err, "make the pictures smaller (relume sheet --size)"), large.err);
    REQUIRE_EQ(runRelume(folder, "sheet one.relume --size 40x30 -o sky.png").exitCode, 0);
    CHECK(sizeOfPng(contents(folder.path() / "sky.png")) == std::pair<uint32_t, uint32_t>(40, 30));
}

TEST_CASE("sheet: what it cannot draw, it says before it begins") {
    const TemporaryFolder folder;
    folder.write("a.relume", "no bake");
    CHECK_EQ(runRelume(folder, "sheet a.relume -o sheet.exr").exitCode, 2);
    CHECK_EQ(runRelume(folder, "sheet a.relume -o sheet.png").exitCode, 1);
    CHECK_EQ(runRelume(folder, "sheet a.relume -e none.hdr -o sheet.png").exitCode, 1);
    CHECK(contents(folder.path() / "a.relume") == "no bake");
}

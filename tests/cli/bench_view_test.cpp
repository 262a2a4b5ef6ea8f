#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume::test;

TEST_CASE("cli: bench view prints changes of view and of light of every bake") {
    const TemporaryFolder folder;
    const auto bake = [&](const std::string& terms, const std::string& layout, const std::string& file) {
        const std::string scene = "bake " + ballIn(folder) +
                                  " --ground --ground-tessellation 4 -N 8 --bounces 0 --visibility-size 64 "
                                  "--face-size 32 --map-size 16 -q -K ";
        REQUIRE_EQ(runRelume(folder, scene + terms + " --layout " + layout + " -o " + file).exitCode, 0);
    };
    bake("2", "rows", "two.relume");
    bake("4", "bases", "four.relume");
    const Outcome outcome =
        runRelume(folder, "bench view two.relume four.relume --size 80x60 --repeats 3 --json");
    REQUIRE_EQ(outcome.exitCode, 0);
    const auto found = nlohmann::json::parse(outcome.out);
    CHECK_EQ(found["width"], 80);
    CHECK_EQ(found["height"], 60);
    CHECK_EQ(found["repeats"], 3);
    REQUIRE_EQ(found["files"].size(), 2u);
    for (size_t i = 0; i < 2; i++) {
        const auto& file = found["files"][i];
        CHECK_EQ(file["file"], i == 0 ? "two.relume" : "four.relume");
        CHECK_EQ(file["parts"][0]["terms"], i == 0 ? 2 : 4);
        CHECK_EQ(file["parts"][0]["layout"], i == 0 ? "rows" : "bases");
        uint64_t vertices = 0;
        for (const auto& part : file["parts"]) vertices += part["vertices"].get<uint64_t>();
        CHECK_EQ(file["vertices"], vertices);
        CHECK_GT(file["triangles"], 0);
        CHECK_GT(file["light_coefficients"], 0);
        CHECK_GT(file["covered_pixels"], 80 * 60 / 10);
        CHECK_LT(file["covered_pixels"], 80 * 60);
        CHECK_GT(file["view_ms"], 0);
        CHECK_GT(file["light_ms"], file["light_passes_ms"]["view"]);
        CHECK_FALSE(file["view_passes_ms"].contains("relight"));
        CHECK_GT(file["view_passes_ms"]["view"], 0);
        CHECK_GT(file["light_passes_ms"]["relight"], 0);
        CHECK_EQ(file["view_fps"].get<double>(), doctest::Approx(1000 / file["view_ms"].get<double>()));
    }
    const Outcome table = runRelume(folder, "bench view four.relume --size 80x60 --repeats 1 --samples 4,1");
    CHECK_EQ(table.exitCode, 0);
    CHECK(says(table.out, "1 samples: a change of light"));
    CHECK(says(table.out, "4+1"));
    CHECK(says(table.out, "80 x 60"));
    const Outcome misplaced = runRelume(folder, "bench --repeats 3 view four.relume");
    CHECK_EQ(misplaced.exitCode, 2);
    CHECK(says(misplaced.err, "--repeats"));
    const Outcome missing = runRelume(folder, "bench view none.relume");
    CHECK_NE(missing.exitCode, 0);
    CHECK(says(missing.err, "none.relume"));
}

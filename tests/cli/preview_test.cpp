// A bake with previews that is killed: what it leaves can be shown, and it goes on to the same bytes.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume::test;

namespace {

const std::string kBakeIn =
    "bake mesh.obj --ground --refine off -K 2 -N 8 --bounces 0 --visibility-size 64 --face-size "
    "32 --map-size 8 -q -o out.relume --layout ";
std::string killAt(int call) {
    return std::string(kNoThreads) +
           " LD_PRELOAD='" RELUME_FAULTS
           "' RELUME_FAULT_PATH=out.relume RELUME_FAULT=kill RELUME_FAULT_CALL=" +
           std::to_string(call);
}

} // namespace

TEST_CASE("preview: killed at a write, a bake leaves a file that is whole, and goes on to the same bytes") {
    for (const std::string layout : {"rows --ground-tessellation 12 ", "bases --ground-tessellation 50 "}) {
        CAPTURE(layout);
        const std::string kBake = kBakeIn + layout;
        const BakeFolder undisturbed;
        REQUIRE_EQ(runRelume(undisturbed, kBake, kNoThreads).exitCode, 0);
        const std::string whole = contents(undisturbed.path() / "out.relume");
        int call = 1, previews = 0;
        // Each write costs two bakes.
        for (;; call += faultStride(says(layout, "rows") ? 13 : 59)) {
            CAPTURE(call);
            const BakeFolder folder;
            const auto output = folder.path() / "out.relume";
            const Outcome bake = runRelume(folder, kBake + "--preview", killAt(call));
            if (bake.exitCode == 0) {
                CHECK(contents(output) == whole);
                break;
            }
            CHECK_EQ(bake.exitCode, 137);
            if (std::filesystem::exists(output) && contents(output) != whole) {
                const Outcome info = runRelume(folder, "info --json out.relume");
                REQUIRE_MESSAGE(info.exitCode == 0, info.err);
                const double share = nlohmann::json::parse(info.out)["preview"]["baked_share"].get<double>();
                CHECK_GE(share, 0);
                CHECK_LT(share, 1);
                if (previews++ == 0) {
                    const Outcome render =
                        runRelume(folder, "render out.relume --size 32x24 -o out.png", kNoThreads);
                    CHECK_EQ(render.exitCode, 0);
                    CHECK(says(render.err, "out.relume: is a preview"));
                }
            }
            const Outcome resumed = runRelume(folder, kBake + (call % 2 == 0 ? "--preview" : ""), kNoThreads);
            REQUIRE_MESSAGE(resumed.exitCode == 0, resumed.err);
            CHECK(contents(output) == whole);
            CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume.checkpoint"));
            CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume.checkpoint.preview"));
        }
        CHECK_GT(previews, 1);
    }
}

TEST_CASE("preview: its events") {
    for (const std::string layout : {"rows --ground-tessellation 12 ", "bases --ground-tessellation 50 "}) {
        const BakeFolder folder;
        const Outcome bake = runRelume(folder, kBakeIn + layout + "--preview --json", kNoThreads);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
        const auto stage = bake.out.find(R"({"event":"stage","stage":"preview","part":"ground"})");
        const auto preview = bake.out.find(R"({"event":"preview","baked_share":)");
        const auto baking = bake.out.find(R"({"event":"stage","stage":"baking")");
        REQUIRE_NE(stage, std::string::npos);
        REQUIRE_NE(baking, std::string::npos);
        CHECK_LT(stage, preview);
        CHECK_LT(preview, baking);
        CHECK(says(bake.out, R"("event":"done")"));
    }
}

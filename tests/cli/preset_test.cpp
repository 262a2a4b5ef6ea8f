// Options that one word asks for.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

nlohmann::json infoOf(const TemporaryFolder& folder, const std::string& file) {
    const Outcome info = runRelume(folder, "info --json " + file);
    REQUIRE_MESSAGE(info.exitCode == 0, info.err);
    return nlohmann::json::parse(info.out);
}

} // namespace

TEST_CASE("presets: paper bakes and renders as its options do, and others beside it win") {
    const TemporaryFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
    const auto bake = [&](const std::string& arguments) {
        const Outcome outcome = runRelume(folder, "bake a.obj -m clay -q " + arguments);
        CHECK_MESSAGE(outcome.exitCode == 0, outcome.err);
    };
    bake("--preset paper -o paper.relume");
    bake("-K 4 --factorization paper --layout rows --visibility raster --transport-samples 16 "
         "--occluder 5000 --refine off --bounces 0 -o options.relume");
    CHECK_EQ(contents(folder.path() / "paper.relume"), contents(folder.path() / "options.relume"));
    CHECK_EQ(infoOf(folder, "paper.relume")["preset"], "paper");

    bake("--preset paper --coefficients 32 -K 1 --factorization normalized --visibility traced -o "
         "other.relume");
    const nlohmann::json other = infoOf(folder, "other.relume");
    CHECK(other["preset"].is_null());
    CHECK_EQ(other["coefficients"], 32);
    const nlohmann::json& options = other["provenance"]["options"];
    CHECK_EQ(options["terms"], 1);
    CHECK_EQ(options["factorization"], "normalized");
    CHECK_EQ(options["visibility"], "traced");
    CHECK_EQ(options["transport_samples"], 16);

    // The preset gives way where what is given leaves no room for it.
    bake("--preset paper --visibility-size 64 --error 0.05 -o smaller.relume");
    const nlohmann::json smaller = infoOf(folder, "smaller.relume")["provenance"]["options"];
    CHECK_EQ(smaller["transport_samples"], 1);
    CHECK_EQ(smaller["layout"], "bases");

    const auto render = [&](const std::string& arguments) {
        const Outcome outcome =
            runRelume(folder, "render paper.relume --size 32x24 -o image.exr " + arguments);
        CHECK_MESSAGE(outcome.exitCode == 0, outcome.err);
        return contents(folder.path() / "image.exr");
    };
    const std::string paper = render("--preset paper");
    CHECK_EQ(paper, render("--residual off --threshold 1024"));
    CHECK_NE(paper, render(""));
    CHECK_EQ(render("--preset paper --coefficients 1024 --residual on"), render("--preset default"));
}

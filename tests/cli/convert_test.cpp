// Transport in every layout: converted, explained, drawn, verified and timed.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume::test;
using Json = nlohmann::json;

namespace {

void bakeSphere(const TemporaryFolder& folder) {
    succeed(folder,
            "bake " + ballIn(folder) +
                " --ground --ground-tessellation 10 -m gold -K 2 -N 200 --bounces 0 --visibility-size 64 "
                "--face-size 32 --map-size 16 --layout rows -q -o rows.relume");
}

} // namespace

TEST_CASE(
    "convert: every layout says what it is, relights to the reference's bits, and draws the same image") {
    const TemporaryFolder folder;
    bakeSphere(folder);
    succeed(folder, "render rows.relume --size 96x72 --threshold 0 -o rows.exr");
    const Json rows = Json::parse(succeed(folder, "info rows.relume --json").out);
    const Outcome convert =
        succeed(folder, "convert rows.relume --layout bases --error 0.03 -o bases.relume");
    CHECK(says(convert.err, "bytes"));
    const Json info = Json::parse(succeed(folder, "info bases.relume --json").out);
    CHECK_EQ(info["parts"][0]["sets"][0]["layout"], "bases");
    CHECK_EQ(info["layout_error"]["wanted_error"], 0.03);
    CHECK_LE(info["layout_error"]["error"], 0.032); // rounding to bytes adds to what was asked for
    CHECK_LT(info["total"]["bytes_per_vertex"], rows["total"]["bytes_per_vertex"]);
    const Json verify = Json::parse(succeed(folder, "verify bases.relume --samples 20 --json").out);
    CHECK_EQ(verify["relight_bits"], 0);
    CHECK_GT(verify["layout_error"], 0);
    succeed(folder, "render bases.relume --size 96x72 --threshold 0 -o bases.exr");
    const Json compare = Json::parse(succeed(folder, "compare bases.exr rows.exr --json").out);
    CHECK_LE(compare["relative_rmse"], 0.05);
    CHECK_GT(compare["relative_rmse"], 0);
    succeed(folder, "convert bases.relume --layout rows -o again.relume");
    const auto error = [&](const std::string& file) -> double {
        return Json::parse(succeed(folder, "info " + file + " --json").out)["layout_error"]["error"];
    };
    CHECK_EQ(error("again.relume"), error("bases.relume")); // what was lost stays so
    succeed(folder, "convert bases.relume --layout bases --error 0.1 -o twice.relume");
    CHECK_GT(error("twice.relume"), error("bases.relume"));
    succeed(folder, "convert rows.relume --layout rows -N 20 -o short.relume");
    CHECK_EQ(Json::parse(succeed(folder, "info short.relume --json").out)["coefficients"], 20);
    succeed(folder, "render again.relume --size 96x72 --threshold 0 -o again.exr");
    CHECK_LE(Json::parse(succeed(folder, "compare again.exr bases.exr --json").out)["relative_rmse"], 0.02);
}

TEST_CASE("convert: the same bytes every time, within the budget, and errors that say what to do") {
    const TemporaryFolder folder;
    bakeSphere(folder);
    succeed(folder, "convert rows.relume --budget 60 -q -o a.relume");
    succeed(folder, "convert rows.relume --budget 60 -q -o b.relume");
    CHECK(contents(folder.path() / "a.relume") == contents(folder.path() / "b.relume"));
    const Json info = Json::parse(succeed(folder, "info a.relume --json").out);
    CHECK_LE(info["total"]["bytes_per_vertex"], 60);
    CHECK_GE(info["total"]["bytes_per_vertex"], 40);

    const auto fails = [&](const std::string& arguments, const std::string& what) {
        const Outcome outcome = runRelume(folder, "convert " + arguments);
        CAPTURE(outcome.err);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, what));
    };
    fails("rows.relume --layout rows --budget 60 -o c.relume", "--budget");
    fails("rows.relume --layout bases -N 60 -o c.relume", "--coefficients");
    fails("rows.relume --layout cells -o c.relume", "cells");
    fails("rows.relume -o rows.relume", "would be written over");
    fails("rows.relume --budget 60 --error 0.1 -o c.relume", "--budget");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "c.relume"));
}

TEST_CASE("bake: bases unless another layout is asked for, about as small and as exact as it says") {
    const TemporaryFolder folder;
    const auto bake = [&](const std::string& options) {
        const Outcome outcome =
            succeed(folder, "bake " + ballIn(folder) +
                                " --ground --ground-tessellation 60 -m gold -K 1 --face-size 32 "
                                "--bounces 0 --visibility-size 64 --map-size 16 -q -o a.relume " +
                                options);
        CHECK(says(outcome.err, "bytes a vertex"));
        Json info = Json::parse(succeed(folder, "info a.relume --json").out);
        info["layout"] = info["parts"][0]["sets"][0]["layout"];
        return info;
    };
    CHECK_EQ(bake("-N 100")["layout_error"]["wanted_error"], 0.0125); // all sets have one term
    const Json usual = bake("-N 100 --error 0.05");
    CHECK_EQ(usual["layout"], "bases");
    CHECK_EQ(usual["layout_error"]["wanted_error"], 0.05);
    CHECK(usual["layout_error"]["error"].get<double>() == doctest::Approx(0.05).epsilon(0.15));
    CHECK(says(usual["approximations"].dump(), "5 % being asked for"));
    CHECK_EQ(usual["provenance"]["options"]["layout"], "bases");
    const Json few = bake("-N 100 --budget 30");
    CHECK_EQ(few["layout_error"]["wanted_bytes_per_vertex"], 30);
    CHECK(few["total"]["bytes_per_vertex"].get<double>() == doctest::Approx(30).epsilon(0.15));
    const Json rows = bake("--layout rows");
    CHECK_EQ(rows["coefficients"], 96);
    CHECK(rows["layout_error"].is_null());

    for (const char* wrong : {"--layout rows --error 0.1", "--layout rows --budget 60", "--layout clusters",
                              "--error 0.1 --budget 60", "--error 0", "--budget 0.5"}) {
        const Outcome outcome = runRelume(folder, std::string("bake sphere -o b.relume ") + wrong);
        CAPTURE(outcome.err);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, "--"));
    }
}

TEST_CASE("cli: bench relight prints every layout's figures as JSON") {
    const TemporaryFolder folder;
    bakeSphere(folder);
    const Json found =
        Json::parse(succeed(folder, "bench relight rows.relume -N 40 --budget 60 --repeats 2 --json").out);
    CHECK_EQ(found["repeats"], 2);
    CHECK_EQ(found["source_coefficients"], 200);
    CHECK_GT(found["eigen_csr_ms"], 0);
    CHECK_GT(found["light_coefficients"], 0);
    for (const char* layout : {"rows", "bases"}) {
        CAPTURE(layout);
        const Json& own = found["layouts"][layout];
        for (const char* figure : {"ms", "fps", "cpu_ms", "floor_ms", "bytes_touched", "ratio_to_eigen_csr"})
            CHECK_GT(own[figure], 0);
        CHECK_GT(own["relit_error"], 0);
        CHECK_LE(own["relit_error"], 0.5);
    }
    CHECK_EQ(found["layouts"]["rows"]["ratio_to_rows"], 1);
    CHECK_LE(found["layouts"]["bases"]["bytes_per_vertex"], 60);
    const Outcome table = succeed(folder, "bench relight rows.relume --repeats 1");
    CHECK(says(table.out, "Eigen CSR"));
    CHECK_EQ(runRelume(folder, "bench --json relight rows.relume").exitCode, 2);
}

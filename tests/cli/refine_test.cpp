// Bakes that refine their meshes: by themselves, in shards, previewed, rebaked.
#include "tests/support/capture_binding.h"
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume::test;
using nlohmann::json;

namespace {

// A triangle over a ground.
struct RefineFolder : BakeFolder {
    Outcome bake(const std::string& arguments, const std::string& input = "mesh.obj --ground") const {
        return runRelume(
            *this,
            "bake " + input +
                " --refine 0.05 -K 1 -N 8 --bounces 0 --visibility-size 64 --face-size 32 --map-size 8 "
                "--layout rows -q " +
                arguments,
            kNoThreads);
    }
    json info(const std::string& file) const {
        const Outcome info = runRelume(*this, "info --json " + file);
        REQUIRE_MESSAGE(info.exitCode == 0, info.err);
        return json::parse(info.out);
    }
    std::string bytes(const std::string& name) const { return contents(path() / name); }
};

} // namespace

TEST_CASE("refine: says what it did, and does it again to the same bytes") {
    const RefineFolder folder;
    REQUIRE_EQ(folder.bake("-o first.relume").exitCode, 0);
    REQUIRE_EQ(folder.bake("--threads 1 -o second.relume").exitCode, 0);
    const std::string first = folder.bytes("first.relume");
    CHECK(first == folder.bytes("second.relume"));

    const json info = folder.info("first.relume");
    CAPTURE(info.dump());
    const json& refinement = info["refinement"];
    CHECK_EQ(refinement["wanted_error"], 0.05);
    CHECK(refinement["error"] <= 0.05);
    CHECK(refinement["start_error"] > 0.05);
    CHECK_EQ(refinement["start_vertices"], 3 + 17 * 17); // the ground starts coarse
    CHECK(refinement["vertices"] > refinement["start_vertices"]);
    CHECK_EQ(refinement["vertices"], info["total"]["vertices"]);
    CHECK_EQ(info["occluder_triangles"], 3);
    CHECK(says(info["approximations"].dump(), "meshes refined from 292 to"));
    CHECK(says(runRelume(folder, "info first.relume").out, "refinement:"));
    CHECK_EQ(runRelume(folder, "render first.relume --size 64x48 -o image.exr", kNoThreads).exitCode, 0);
}

TEST_CASE("refine: shards, previews and other materials keep to the same meshes") {
    const RefineFolder folder;
    REQUIRE_EQ(folder.bake("--keep-visibility -o kept.relume").exitCode, 0);
    REQUIRE_EQ(folder.bake("-o whole.relume").exitCode, 0);
    const std::string whole = folder.bytes("whole.relume");
    REQUIRE_EQ(folder.bake("--shard 0/2 -o 0.relume").exitCode, 0);
    REQUIRE_EQ(folder.bake("--shard 1/2 -o 1.relume").exitCode, 0);
    REQUIRE_EQ(runRelume(folder, "merge 0.relume 1.relume -o merged.relume").exitCode, 0);
    CHECK(folder.bytes("merged.relume") == whole);
    REQUIRE_EQ(folder.bake("--preview -o preview.relume").exitCode, 0);
    CHECK(folder.bytes("preview.relume") == whole);
    REQUIRE_EQ(runRelume(folder, "rebake kept.relume -q -o same.relume", kNoThreads).exitCode, 0);
    CHECK(folder.bytes("same.relume") == whole);
    const Outcome rebake = runRelume(folder, "rebake kept.relume -q -m gold -o gold.relume", kNoThreads);
    REQUIRE_MESSAGE(rebake.exitCode == 0, rebake.err);
    CHECK_EQ(folder.info("gold.relume")["refinement"], folder.info("whole.relume")["refinement"]);
}

TEST_CASE("refine: a ground whose tessellation is given starts with it") {
    const RefineFolder folder;
    REQUIRE_EQ(folder.bake("--ground-tessellation 5 -o option.relume").exitCode, 0);
    CHECK_EQ(folder.info("option.relume")["refinement"]["start_vertices"], 3 + 6 * 6);
    for (const auto& [ground, vertices] :
         {std::pair(R"({"tessellation": 6})", 3 + 7 * 7), std::pair("true", 292)}) {
        CAPTURE_BINDING(ground);
        folder.write("scene.json", std::string(R"({"parts": [{"mesh": "mesh.obj", "material": "clay"}], )") +
                                       R"("ground": )" + ground + "}");
        REQUIRE_EQ(folder.bake("-o scene.relume", "scene.json").exitCode, 0);
        CHECK_EQ(folder.info("scene.relume")["refinement"]["start_vertices"], vertices);
    }
}

TEST_CASE("refine: by itself a bake adds vertices to coarse parts alone") {
    const RefineFolder folder;
    const auto bake = [&](const std::string& input, const std::string& output) {
        const Outcome outcome =
            runRelume(folder,
                      "bake " + input +
                          " -K 1 -N 8 --bounces 0 --visibility-size 64 --face-size 32 --map-size 8 "
                          "--layout rows -q -o " +
                          output,
                      kNoThreads);
        REQUIRE_MESSAGE(outcome.exitCode == 0, outcome.err);
    };
    bake("mesh.obj --ground", "coarse.relume");
    const json coarse = folder.info("coarse.relume");
    CHECK_EQ(coarse["refinement"]["auto"], true);
    CHECK_EQ(coarse["refinement"]["start_vertices"], 3 + 17 * 17);
    CHECK(coarse["total"]["vertices"] > 3 + 17 * 17);
    CHECK(coarse["total"]["vertices"] <= 20000);
    // A mesh that is fine stays as it is, and a ground as it was asked for.
    folder.write("fine.obj", sampleObj(relume::makePlane(2, 99)));
    bake("fine.obj --ground --ground-tessellation 9", "fine.relume");
    const json fine = folder.info("fine.relume");
    CHECK_FALSE(fine.contains("refinement"));
    CHECK_EQ(fine["parts"][0]["vertices"], 100 * 100);
    CHECK_EQ(fine["parts"][1]["vertices"], 10 * 10);
}

TEST_CASE("refine: its event") {
    const RefineFolder folder;
    const Outcome bake =
        runRelume(folder,
                  "bake mesh.obj --ground --refine 0.1 -K 1 -N 8 --bounces 0 --visibility-size 64 "
                  "--face-size 32 --map-size 8 --layout rows --json -o out.relume",
                  kNoThreads);
    REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    std::istringstream lines(bake.out);
    std::vector<std::string> order;
    for (std::string line; std::getline(lines, line);) {
        const json event = json::parse(line);
        if (event["event"] == "stage") order.push_back(event["stage"]);
        if (event["event"] == "start") order.push_back("start");
        if (event["event"] != "refined") continue;
        order.push_back("refined");
        CHECK_EQ(event["wanted_error"], 0.1);
        CHECK(event["error"] <= 0.1);
        CHECK_EQ(event["start_vertices"], 292);
    }
    const std::vector<std::string> expected = {"occluder", "factorization", "refinement", "refined", "start"};
    REQUIRE(order.size() > expected.size());
    order.resize(expected.size());
    CHECK(order == expected);
}

TEST_CASE("refine: errors that cannot be asked for") {
    const RefineFolder folder;
    for (const std::string error : {"0", "-1", "0.0005", "1.5", "1e300", "nan", "inf", "fine"}) {
        CAPTURE(error);
        const Outcome bake = runRelume(folder, "bake mesh.obj --refine " + error + " -o out.relume");
        CHECK_EQ(bake.exitCode, 2);
        CHECK(says(bake.err, "--refine"));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume"));
    }
}

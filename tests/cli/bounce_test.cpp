// Bakes with bounced light: their bytes do not depend on threads, shards or kills, and what reads them knows.
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume::test;

namespace {

// Two walls over a ground, which light each other.
struct CornerFolder : TemporaryFolder {
    CornerFolder() { write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"); }
    std::string read(const std::string& name) const { return contents(path() / name); }
};

const std::string kBounceBake =
    "bake mesh.obj --ground --ground-tessellation 12 --refine off -m gold -K 2 -N 32 "
    "--layout rows --visibility-size 64 --face-size 32 --map-size 8 -q ";
} // namespace

TEST_CASE("bounces: two are the default, with the same bytes, and none are told of") {
    const CornerFolder folder;
    succeed(folder, kBounceBake + "-o plain.relume");
    succeed(folder, kBounceBake + "--bounces 0 -o none.relume");
    succeed(folder, kBounceBake + "--bounces 2 -o two.relume");
    CHECK(folder.read("plain.relume") == folder.read("two.relume"));
    CHECK(folder.read("plain.relume") != folder.read("none.relume"));
    CHECK(says(succeed(folder, "info two.relume").out, "by up to 2 reflections between surfaces"));
    CHECK(says(succeed(folder, "info none.relume").out, "direct alone"));
    const Outcome errors = runRelume(folder, "errors two.relume --size 8x8 --bounces 1", kNoThreads);
    CHECK(errors.exitCode == 2);
    CHECK(says(errors.err, "--bounces: expected 2, as many as the bake has, to 8, found 1"));
    const Outcome many = runRelume(folder, kBounceBake + "--bounces 9 -o many.relume", kNoThreads);
    CHECK(many.exitCode == 2);
    CHECK(says(many.err, "--bounces: expected 0 to 8, found 9"));
    succeed(folder, "convert two.relume --layout bases -o bases.relume");
    CHECK(says(succeed(folder, "info bases.relume").out, "by up to 2 reflections between surfaces"));
}

TEST_CASE("bounces: none by default where materials share terms, but where they are asked for") {
    const CornerFolder folder;
    succeed(folder, kBounceBake + "-m clay -o set.relume");
    CHECK(says(succeed(folder, "info set.relume").out, "direct alone"));
    succeed(folder, kBounceBake + "-m clay --bounces 1 -o asked.relume");
    CHECK(says(succeed(folder, "info asked.relume").out, "by one reflection between surfaces"));

    succeed(folder, kBounceBake + "--keep-visibility -o gold.relume");
    succeed(folder, "rebake gold.relume -m gold -m clay -q -o rebaked.relume");
    CHECK(folder.read("rebaked.relume") == folder.read("set.relume"));
    succeed(folder, "rebake gold.relume -m gold -m clay --bounces 2 -q -o both.relume");
    CHECK(says(succeed(folder, "info both.relume").out, "by up to 2 reflections between surfaces"));
}

TEST_CASE("bounces: any threads, shards and kills give the same bytes") {
    const CornerFolder folder;
    const std::string bake = kBounceBake + "--bounces 2 ";
    succeed(folder, bake + "-o whole.relume");
    const std::string whole = folder.read("whole.relume");
    succeed(folder, bake + "--threads 1 -o single.relume");
    CHECK(folder.read("single.relume") == whole);

    for (const std::string part : {"0", "1"})
        succeed(folder, bake + "--shard " + part + "/2 -o part-" + part + ".relume");
    succeed(folder, "merge part-0.relume part-1.relume -o merged.relume");
    CHECK(folder.read("merged.relume") == whole);

    int kills = 0;
    for (int call = 1; call < 64; call++, kills++) {
        const Outcome killed = runRelume(folder, bake + "-o out.relume",
                                         std::string(kNoThreads) +
                                             " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_PATH=out.relume "
                                             "RELUME_FAULT=kill RELUME_FAULT_CALL=" +
                                             std::to_string(call));
        if (killed.exitCode == 0) break;
        REQUIRE(killed.exitCode == 137);
    }
    CHECK(kills > 1); // and went on from a checkpoint each time
    succeed(folder, bake + "-o out.relume");
    CHECK(folder.read("out.relume") == whole);
}

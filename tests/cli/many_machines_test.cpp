// A bake in shards, and the shards merged: to the bytes of the whole bake.
#include "engine/base/file.h"
#include "engine/transport/asset_arrays.h"
#include "tests/support/asset_sample.h"
#include "tests/support/run_relume.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

// A triangle over a ground: parts of one and of seven blocks, little work each.
const std::string kShardBake =
    "bake mesh.obj --ground --ground-tessellation 20 --refine off -K 1 -N 8 --bounces 0 --visibility-size 64 "
    "--face-size 32 --map-size 8 --layout rows -q ";
constexpr int kBlocks = 8;
struct ShardFolder : BakeFolder {
    std::string read(const std::string& name) const { return contents(path() / name); }
    void put(const std::string& name, const std::string& bytes) const {
        std::ofstream(path() / name, std::ios::binary) << bytes;
    }
};

std::string shardOf(int index, int count) {
    const std::string number = std::to_string(index);
    return kShardBake + "--shard " + number + "/" + std::to_string(count) + " -o part-" + number + ".relume ";
}

void bakeShards(const ShardFolder& folder, int count) {
    for (int index = 0; index < count; index++) {
        const Outcome bake = runRelume(folder, shardOf(index, count), kNoThreads);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    }
}

// The bytes of a bake by one machine.
const std::string& whole() {
    static const std::string bytes = [] {
        const ShardFolder folder;
        const Outcome bake = runRelume(folder, kShardBake + "-o whole.relume", kNoThreads);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
        return folder.read("whole.relume");
    }();
    return bytes;
}

// Merges, and expects to be refused without a trace.
std::string refusal(const ShardFolder& folder, const std::string& parts) {
    const Outcome merge = runRelume(folder, "merge " + parts + " -o refused.relume");
    CAPTURE(merge.err);
    CHECK_EQ(merge.exitCode, 1);
    for (const auto& file : std::filesystem::directory_iterator(folder.path()))
        CHECK_FALSE(says(file.path().filename().string(), "refused"));
    return merge.err;
}

} // namespace

TEST_CASE("many machines: four shards under mpirun, merged, are the whole bake") {
    const ShardFolder folder;
    // What docs/many_machines.md shows.
    folder.put("bake.sh", "part=\"part-$OMPI_COMM_WORLD_RANK.relume\"\n"
                          "test -e \"$part\" && exit\n"
                          "exec '" RELUME_PROGRAM "' " +
                              kShardBake +
                              "--shard \"$OMPI_COMM_WORLD_RANK/$OMPI_COMM_WORLD_SIZE\" -o \"$part\"\n");
    const std::string command =
        "cd '" + folder.path().string() + "' && " + kNoThreads +
        " mpirun --allow-run-as-root --oversubscribe -n 4 sh bake.sh >mpi.txt 2>&1 </dev/null";
    REQUIRE_MESSAGE(std::system(command.c_str()) == 0, folder.read("mpi.txt"));
    const Outcome merge =
        runRelume(folder, "merge part-2.relume part-0.relume part-3.relume part-1.relume -o merged.relume");
    REQUIRE_MESSAGE(merge.exitCode == 0, merge.err);
    CHECK(says(merge.err, "444 vertices from 4 parts"));
    CHECK(folder.read("merged.relume") == whole());
}

TEST_CASE("many machines: one shard, two, and more than there are blocks") {
    for (int count : {1, 2, kBlocks + 2}) {
        CAPTURE(count);
        const ShardFolder folder;
        bakeShards(folder, count);
        const Outcome merge = runRelume(folder, "merge part-*.relume -o merged.relume");
        REQUIRE_MESSAGE(merge.exitCode == 0, merge.err);
        CHECK(folder.read("merged.relume") == whole());
    }
}

TEST_CASE("many machines: shards in bases, merged, are the whole bake") {
    const ShardFolder folder;
    // 1681 vertices of ground: seven blocks of bases, more than the sample has.
    const std::string bake = "bake mesh.obj --ground --ground-tessellation 40 --refine off -K 1 -N 40 "
                             "--bounces 0 --visibility-size 64 "
                             "--face-size 32 --map-size 8 --keep-visibility -q --budget 40 -o ";
    REQUIRE_EQ(runRelume(folder, bake + "whole.relume", kNoThreads).exitCode, 0);
    for (const int count : {2, 12}) {
        std::string parts;
        for (int index = 0; index < count; index++) {
            const std::string part = "part-" + std::to_string(index) + ".relume";
            const Outcome shard = runRelume(
                folder, bake + part + " --shard " + std::to_string(index) + "/" + std::to_string(count),
                kNoThreads);
            REQUIRE_MESSAGE(shard.exitCode == 0, shard.err);
            parts += " " + part;
        }
        const Outcome merge = runRelume(folder, "merge" + parts + " -o merged.relume");
        REQUIRE_MESSAGE(merge.exitCode == 0, merge.err);
        CHECK(folder.read("merged.relume") == folder.read("whole.relume"));
    }
    // Kept visibility that lacks a byte, with a right checksum.
    std::vector<RawChunk> chunks = chunksOf(readFile(folder.path() / "part-0.relume"));
    std::ranges::find(chunks, kVisibility, &RawChunk::tag)->raw.pop_back();
    const std::vector<std::byte> damaged = fileOf(chunks);
    folder.put("part-0.relume", {reinterpret_cast<const char*>(damaged.data()), damaged.size()});
    std::string parts;
    for (int index = 0; index < 12; index++) parts += " part-" + std::to_string(index) + ".relume";
    const Outcome merge = runRelume(folder, "merge" + parts + " -o merged.relume");
    CHECK_EQ(merge.exitCode, 1);
    CHECK(says(merge.err, "part-0.relume: chunk visb of part 0, run 0: "));
    CHECK(folder.read("merged.relume") == folder.read("whole.relume")); // of the merge before
}

TEST_CASE("many machines: a shard counts its own vertices, and goes on from its own checkpoint") {
    const ShardFolder folder;
    // Shard 1 has blocks 1, 3, 5 and 7: of the ground, 64 + 64 + 64 + 57 vertices. The fourth write is of the
    // third.
    const std::string killed = std::string(kNoThreads) + " LD_PRELOAD='" RELUME_FAULTS
                                                         "' RELUME_FAULT_PATH=part-1.relume"
                                                         " RELUME_FAULT=kill RELUME_FAULT_CALL=5";
    REQUIRE_EQ(runRelume(folder, shardOf(1, 2), killed).exitCode, 137);
    CHECK(std::filesystem::exists(folder.path() / "part-1.relume.checkpoint"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "part-1.relume"));
    const Outcome bake = runRelume(folder, shardOf(1, 2) + "--json", kNoThreads);
    REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    const int own = 3 * 64 + 57;
    CHECK(says(bake.out, "{\"event\":\"start\",\"vertices\":" + std::to_string(own) + ",\"done\":128}"));
    nlohmann::json last;
    std::istringstream lines(bake.out);
    for (std::string line; std::getline(lines, line);) {
        const auto event = nlohmann::json::parse(line);
        if (event["event"] == "progress") last = event;
    }
    CHECK_EQ(last["done"], own);
    CHECK_EQ(last["vertices"], own);
    CHECK_EQ(last["fraction"], 1);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "part-1.relume.checkpoint"));
    REQUIRE_EQ(runRelume(folder, shardOf(0, 2), kNoThreads).exitCode, 0);
    REQUIRE_EQ(runRelume(folder, "merge part-0.relume part-1.relume -o merged.relume").exitCode, 0);
    CHECK(folder.read("merged.relume") == whole());
}

TEST_CASE("many machines: what cannot be joined is refused, and why is said") {
    const ShardFolder folder;
    bakeShards(folder, 2);
    CHECK(says(refusal(folder, "part-0.relume"), "1 of 2 shards missing: 1/2"));
    CHECK(says(refusal(folder, "part-0.relume part-1.relume part-0.relume"), "part-0.relume: is shard 0/2"));
    CHECK(says(refusal(folder, "part-0.relume absent.relume"), "absent.relume: cannot be read"));
    folder.put("whole.relume", whole());
    CHECK(says(refusal(folder, "part-0.relume whole.relume"), "whole.relume: is a whole bake"));

    const auto otherShard = [&](const std::string& options) {
        REQUIRE_EQ(runRelume(folder, kShardBake + options + " -o other.relume", kNoThreads).exitCode, 0);
        return refusal(folder, "part-0.relume other.relume");
    };
    CHECK(says(otherShard("--shard 1/3"), "one of 3 shards"));
    CHECK(says(otherShard("--shard 1/2 -m chrome"), "materials: \"mesh: chrome"));
    CHECK(says(otherShard("--shard 1/2 --visibility raster"),
               "option \"visibility\": \"raster\", not \"traced\""));
    folder.put("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 2\nf 1 2 3\n");
    CHECK(says(otherShard("--shard 1/2"), "input \"mesh.obj\": its content"));

    for (const char* command : {"info part-0.relume", "render part-0.relume -o image.png"}) {
        const Outcome outcome = runRelume(folder, command, kNoThreads);
        CHECK_EQ(outcome.exitCode, 1);
        CHECK(says(outcome.err, "part-0.relume: is a shard of a bake"));
        CHECK(says(outcome.err, "relume merge"));
    }
}

TEST_CASE("many machines: parts that were damaged or cut short are refused, whole output stays") {
    const ShardFolder folder;
    bakeShards(folder, 2);
    const std::string good = folder.read("part-1.relume");
    std::mt19937 random(7);
    for (int i = 0; i < 40; i++) {
        std::string damaged = good;
        if (i % 4 == 0)
            damaged.resize(random() % good.size());
        else
            damaged[random() % good.size()] ^= char(1 << random() % 8);
        folder.put("part-1.relume", damaged);
        CHECK(says(refusal(folder, "part-0.relume part-1.relume"), "part-1.relume: "));
    }
    folder.put("part-1.relume", good);
    folder.put("merged.relume", "precious");
    for (int call = 1;; call++) {
        const Outcome merge = runRelume(folder, "merge part-0.relume part-1.relume -o merged.relume",
                                        "LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_PATH=merged.relume "
                                        "RELUME_FAULT=full RELUME_FAULT_CALL=" +
                                            std::to_string(call));
        if (merge.exitCode == 0) {
            CHECK_GT(call, 20); // header, table, every chunk, a flush and a rename
            break;
        }
        CHECK_EQ(merge.exitCode, 1);
        CHECK(says(merge.err, "merged.relume: cannot be written"));
        CHECK(says(merge.err, "make room"));
        CHECK_EQ(folder.read("merged.relume"), "precious");
    }
    CHECK(folder.read("merged.relume") == whole());
}

TEST_CASE("many machines: options that cannot be") {
    const ShardFolder folder;
    const auto usage = [&](const std::string& arguments) {
        const Outcome outcome = runRelume(folder, arguments);
        CHECK_EQ(outcome.exitCode, 2);
        return outcome.err;
    };
    CHECK(says(usage(shardOf(4, 4)), "the first of 4 is 0/4, the last 3/4"));
    CHECK(says(usage(kShardBake + "--shard /4 -o part.relume"), "expected I/N"));
    CHECK(says(usage(kShardBake + "--shard '' -o part.relume"), "--shard: expected a value"));
    CHECK(says(usage("merge part.relume -o merged.png"), "expected a name ending in .relume"));
    folder.put("part.relume", "x");
    CHECK(says(usage("merge part.relume -o ./part.relume"), "would be written over"));
    CHECK_EQ(runRelume(folder, "merge -o merged.relume").exitCode, 2);
}

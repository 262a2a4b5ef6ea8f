// Visibility is kept, and used again: the bytes are those of a whole bake.
#include "tests/support/kept_sample.h"
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

// Two triangles of their own and a ground: parts of one, one and three blocks.
struct RebakeFolder : TemporaryFolder {
    RebakeFolder() {
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
        write("b.obj", "v 0 2 0\nv 1 2 0\nv 0 3 1\nf 1 2 3\n");
        describe("\"clay\"", "\"gold\"");
    }
    void describe(const std::string& a, const std::string& b) const {
        write("scene.json", R"({"parts": [{"mesh": "a.obj", "name": "a", "material": )" + a +
                                R"(}, {"mesh": "b.obj", "name": "b=2", "material": )" + b + "}]}");
    }

    std::string bytes(const std::string& name) const { return contents(path() / name); }

    Outcome bake(const std::string& arguments, const std::string& output,
                 const std::string& environment = kNoThreads) const {
        return runRelume(*this,
                         "bake scene.json --ground --ground-tessellation 12 --refine off --visibility-size "
                         "64 --bounces 0 --face-size 32 "
                         "--map-size 8 -q " +
                             arguments + " -o " + output,
                         environment);
    }
    Outcome rebake(const std::string& arguments, const std::string& output,
                   const std::string& environment = kNoThreads) const {
        return runRelume(*this, "rebake -q " + arguments + " -o " + output, environment);
    }
};

// What a bake of its own makes.
std::string baked(const RebakeFolder& folder, const std::string& arguments) {
    const Outcome bake = folder.bake(arguments, "fresh.relume");
    REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    const std::string bytes = folder.bytes("fresh.relume");
    std::filesystem::remove(folder.path() / "fresh.relume");
    return bytes;
}

constexpr const char* kRows = "-K 2 -N 8 --layout rows";
constexpr const char* kKept = "-K 2 -N 8 --layout rows --keep-visibility";

} // namespace

TEST_CASE("rebake: what is no longer brushed has no tangents, and what stays so keeps its own") {
    const RebakeFolder folder;
    folder.describe("\"brushed-steel\", \"brush_rotation\": 30", "\"gold\"");
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    const Outcome again = folder.rebake("kept.relume -m a=brushed-steel", "again.relume");
    REQUIRE_MESSAGE(again.exitCode == 0, again.err);
    CHECK(folder.bytes("again.relume") == baked(folder, kRows));
    const Outcome plain = folder.rebake("kept.relume -m a=clay", "plain.relume");
    REQUIRE_MESSAGE(plain.exitCode == 0, plain.err);
    const Outcome info = runRelume(folder, "info plain.relume --json");
    CHECK(says(info.out, "brush_rotation"));
    CHECK_FALSE(says(info.out, "tangents"));
}

TEST_CASE("rebake: the bytes are those of a bake of the new materials, terms and coefficients") {
    const RebakeFolder folder;
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    struct Case {
        std::string a, b, bake, rebake;
    };
    for (const Case& c : std::vector<Case>{
             {"\"clay\"", "\"gold\"", kRows, ""},
             {"\"clay\"", "\"gold\"", kKept, "--keep-visibility"},
             {"\"copper\"", "\"copper\"", kRows, "-m copper"},
             {"\"copper\"", "\"gold\"", kRows, "-m a=copper"},
             {"\"brushed-steel\"", "\"gold\"", kRows, "-m a=brushed-steel"}, // which gets tangents
             {"\"copper\"", "\"clay\"", "-K 3 -N 40 --layout rows --ground-material gold",
              "-K 3 -N 40 -m copper -m b=2=clay -m ground=gold"},
             {"{\"set\": [\"clay\", \"gold\"]}", "\"gold\"", "-K 4 -N 8 --layout rows --keep-visibility",
              "-K 4 -m a=clay -m a=gold --keep-visibility"},
             {"{\"separate\": [\"clay\", \"gold\"]}", "\"gold\"", kRows, "-m a=clay -m a=gold --separate"},
             {"\"clay\"", "\"gold\"",
              "-K auto:0.2 -N 8 --layout rows --factorization paper --transport-samples 4",
              "-K auto:0.2 --factorization paper --transport-samples 4"},
             // Blocks of 16 vertices and of 64.
             {"\"clay\"", "\"gold\"", "-K 11 -N 6144 --layout rows --keep-visibility",
              "-K 11 -N 6144 --keep-visibility"},
             // Blocks of 256 vertices.
             {"\"copper\"", "\"gold\"", "-K 2 -N 50 --error 0.1 --keep-visibility",
              "-m a=copper -N 50 --layout bases --error 0.1 --keep-visibility"},
             {"\"clay\"", "\"gold\"", "-K 2 -N 50 --layout bases --budget 500 --keep-visibility",
              "-N 50 --layout bases --budget 500 --keep-visibility"}}) {
        CAPTURE(c.rebake);
        folder.describe(c.a, c.b);
        const Outcome rebake = folder.rebake("kept.relume " + c.rebake, "new.relume");
        REQUIRE_MESSAGE(rebake.exitCode == 0, rebake.err);
        CHECK(says(rebake.err, "visibility of 175 vertices reused"));
        CHECK(folder.bytes("new.relume") == baked(folder, c.bake));
    }
    // The last one's blocks are of another size than the first one's; what is not said is its own.
    folder.describe("\"clay\"", "\"gold\"");
    const Outcome same = folder.rebake("new.relume -K 2", "same.relume");
    REQUIRE_MESSAGE(same.exitCode == 0, same.err);
    CHECK(folder.bytes("same.relume") == baked(folder, "-K 2 -N 50 --layout bases --budget 500"));
    const Outcome back = folder.rebake("new.relume -K 2 -N 8 --layout rows --keep-visibility", "new.relume");
    REQUIRE_MESSAGE(back.exitCode == 0, back.err);
    CHECK(folder.bytes("new.relume") == folder.bytes("kept.relume"));
}

TEST_CASE("rebake: in every size and way of visibility") {
    const RebakeFolder folder;
    for (const std::string how : {"--visibility raster", "--visibility-size 128 --occluder 4"}) {
        CAPTURE(how);
        const Outcome bake = runRelume(folder,
                                       "bake a.obj --up z -m clay -K 2 -N 8 --bounces 0 --map-size 8 -q "
                                       "--keep-visibility -o kept.relume " +
                                           how,
                                       kNoThreads);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
        const Outcome rebake = folder.rebake("kept.relume -m gold", "new.relume");
        REQUIRE_MESSAGE(rebake.exitCode == 0, rebake.err);
        REQUIRE_EQ(
            runRelume(folder,
                      "bake a.obj --up z -m gold -K 2 -N 8 --bounces 0 --map-size 8 -q -o fresh.relume " +
                          how,
                      kNoThreads)
                .exitCode,
            0);
        CHECK(folder.bytes("new.relume") == folder.bytes("fresh.relume"));
        std::filesystem::remove(folder.path() / "fresh.relume");
    }
}

TEST_CASE("rebake: `relume bake` uses what its output keeps, if it fits") {
    const RebakeFolder folder;
    const std::string fresh = baked(folder, "-K 3 -N 12");
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    const std::string kept = folder.bytes("kept.relume");
    const auto restore = [&](std::string bytes) {
        std::ofstream(folder.path() / "kept.relume", std::ios::binary) << bytes;
    };
    const Outcome again = folder.bake("-K 3 -N 12", "kept.relume");
    REQUIRE_MESSAGE(again.exitCode == 0, again.err);
    CHECK(says(again.err, "visibility of 175 vertices reused"));
    CHECK(folder.bytes("kept.relume") == fresh);
    // Another scene, and another way to find it.
    for (const std::string other : {"--ground-extent 5", "--visibility raster"}) {
        restore(kept);
        const Outcome bake = folder.bake("-K 3 -N 12 " + other, "kept.relume");
        REQUIRE_EQ(bake.exitCode, 0);
        CHECK_FALSE(says(bake.err, "reused"));
        CHECK(folder.bytes("kept.relume") == baked(folder, "-K 3 -N 12 " + other));
    }
    // Damaged ones.
    std::mt19937 random(1);
    for (int i = 0; i < 4; i++) {
        std::string damaged = kept;
        if (i == 0)
            damaged.resize(kept.size() - 100);
        else
            damaged[kept.size() - 1 - random() % 2000] ^= char(1 << random() % 8);
        restore(damaged);
        const Outcome bake = folder.bake("-K 3 -N 12", "kept.relume");
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
        CHECK_FALSE(says(bake.err, "reused"));
        CHECK(folder.bytes("kept.relume") == fresh);
    }
}

TEST_CASE("rebake: killed at every write, bake and rebake go on to the same bytes") {
    const auto killedAt = [](int call) {
        return std::string(kNoThreads) +
               " LD_PRELOAD='" RELUME_FAULTS
               "' RELUME_FAULT_PATH=new.relume RELUME_FAULT=kill RELUME_FAULT_CALL=" +
               std::to_string(call);
    };
    const RebakeFolder folder;
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    const std::string kept = folder.bytes("kept.relume");
    for (const bool again : {false, true}) {
        CAPTURE(again);
        const auto run = [&](const std::string& environment) {
            return again ? folder.rebake("kept.relume --keep-visibility", "new.relume", environment)
                         : folder.bake(kKept, "new.relume", environment);
        };
        for (int call = 2; call < 8; call += faultStride(2)) { // a checkpoint's header, five blocks
            CAPTURE(call);
            REQUIRE_EQ(run(killedAt(call)).exitCode, 137);
            CHECK(std::filesystem::exists(folder.path() / "new.relume.checkpoint"));
            const Outcome resumed = run(kNoThreads);
            REQUIRE_MESSAGE(resumed.exitCode == 0, resumed.err);
            CHECK(folder.bytes("new.relume") == kept);
            CHECK_FALSE(std::filesystem::exists(folder.path() / "new.relume.checkpoint"));
            std::filesystem::remove(folder.path() / "new.relume");
        }
    }
}

TEST_CASE("rebake: shards keep visibility, and their merge does") {
    const RebakeFolder folder;
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    for (const std::string shard : {"0", "1"}) {
        const Outcome bake =
            folder.bake(std::string(kKept) + " --shard " + shard + "/2", "part" + shard + ".relume");
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    }
    const Outcome merge = runRelume(folder, "merge part0.relume part1.relume -o whole.relume", kNoThreads);
    REQUIRE_MESSAGE(merge.exitCode == 0, merge.err);
    CHECK(folder.bytes("whole.relume") == folder.bytes("kept.relume"));
}

TEST_CASE("rebake: says what is wrong and what to do") {
    const RebakeFolder folder;
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    REQUIRE_EQ(folder.bake(kRows, "plain.relume").exitCode, 0);
    const auto fails = [&](const std::string& arguments, int code, const std::string& words) {
        CAPTURE(arguments);
        const Outcome rebake = folder.rebake(arguments, "new.relume");
        CHECK_EQ(rebake.exitCode, code);
        CHECK_MESSAGE(says(rebake.err, words), rebake.err);
        CHECK_FALSE(std::filesystem::exists(folder.path() / "new.relume"));
    };
    fails("plain.relume", 1, "--keep-visibility");
    fails("missing.relume", 1, "missing.relume");
    fails("a.obj", 1, "not a .relume file");
    fails("kept.relume -m c=clay", 2, "the bake has a, b=2, ground");
    fails("kept.relume -m no-such", 2, "unknown material");
    fails("kept.relume -m a=clay -m b=2=clay -m gold", 2, "-m ground=gold");
    fails("kept.relume --separate -m clay", 2, "--separate");
    fails("kept.relume -N 0", 2, "--coefficients");
    fails("kept.relume --face-size 64 --transport-samples 4", 2, "--transport-samples");
    // Of another device, mesh or program, as its key says; then of this one, but incomplete.
    const std::string file = folder.bytes("kept.relume");
    const std::vector<RawChunk> chunks = chunksOf(std::as_bytes(std::span(file)));
    std::vector<RawChunk> edited = chunks;
    setVisibilityKey(edited, kVisibilityKey);
    writeFileAtomically(folder.path() / "stale.relume", fileOf(edited));
    fails("stale.relume", 1, "`relume bake --keep-visibility` it again");
    edited = chunks;
    edited.pop_back();
    writeFileAtomically(folder.path() / "incomplete.relume", fileOf(edited));
    fails("incomplete.relume", 1, "expected 3 chunks, found 2");
    const Outcome bake = folder.bake(kRows, "incomplete.relume");
    CHECK_EQ(bake.exitCode, 0);
    CHECK(says(bake.err, "visibility is found anew"));
    CHECK(folder.bytes("incomplete.relume") == folder.bytes("plain.relume"));
    std::string bytes = folder.bytes("kept.relume");
    bytes[bytes.size() - 5] ^= 1;
    std::ofstream(folder.path() / "damaged.relume", std::ios::binary) << bytes;
    fails("damaged.relume", 1, "damaged");
}

TEST_CASE("rebake: info tells what is kept") {
    const RebakeFolder folder;
    REQUIRE_EQ(folder.bake(kKept, "kept.relume").exitCode, 0);
    REQUIRE_EQ(folder.bake(kRows, "plain.relume").exitCode, 0);
    const auto bytesOf = [&](const std::string& file) {
        return nlohmann::json::parse(runRelume(folder, "info --json " + file).out)["kept_visibility"]["bytes"]
            .get<size_t>();
    };
    CHECK_EQ(bytesOf("plain.relume"), 0);
    const size_t table = 5 * 48, key = std::string(",\"visibilityKey\":\"\"").size() + 32;
    const size_t more = folder.bytes("kept.relume").size() - folder.bytes("plain.relume").size();
    CHECK_GE(more, bytesOf("kept.relume") + table);
    CHECK_LE(more, bytesOf("kept.relume") + table + 2 * key); // META is compressed
}

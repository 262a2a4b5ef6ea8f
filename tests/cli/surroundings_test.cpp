// Surroundings that no program chooses: others that bake or draw at the same time, folders that cannot be
// written, and names of files that are any bytes.
#include "tests/support/capture_binding.h"
#include "tests/support/run_relume.h"

#include <array>
#include <atomic>
#include <doctest/doctest.h>
#include <future>
#include <nlohmann/json.hpp>

using namespace relume::test;

namespace {

const std::string kFlatBake =
    "bake mesh.obj --refine off -K 1 -N 8 --layout rows --bounces 0 --visibility-size 64 "
    "--face-size 32 --map-size 8 -q ";

// A picture of in.relume that takes no time.
const std::string kDraw = "render in.relume --size 16x12 --residual off --samples 1 --background none "
                          "--exposure=0 -o ";

struct MeshFolder : TemporaryFolder {
    MeshFolder() { write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"); }
};

std::string baked(const TemporaryFolder& folder, const std::string& options) {
    const Outcome bake = runRelume(folder, kFlatBake + options + " -o baked.relume", kNoThreads);
    REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    std::string bytes = contents(folder.path() / "baked.relume");
    std::filesystem::remove(folder.path() / "baked.relume");
    return bytes;
}

// Quotes an argument for a shell.
std::string quoted(std::string text) {
    for (size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4)
        text.replace(at, 1, "'\\''");
    return "'" + text + "'";
}

} // namespace

TEST_CASE("surroundings: of bakes to one output at once each is whole or refused") {
    const MeshFolder folder;
    const std::string whole = baked(folder, "-m clay");
    // Each says what it has to say to a file of its own.
    const auto bake = [&](int number) {
        const std::string command = "cd " + quoted(folder.path()) + " && " + kNoThreads +
                                    " '" RELUME_PROGRAM "' " + kFlatBake + "-m clay -o out.relume 2>err" +
                                    std::to_string(number) + ".txt";
        return WEXITSTATUS(std::system(command.c_str()));
    };
    int done = 0;
    for (int round = 0; round < 3; round++) {
        std::filesystem::remove(folder.path() / "out.relume");
        std::array<std::future<int>, 3> bakes;
        for (int i = 0; i < 3; i++) bakes[size_t(i)] = std::async(std::launch::async, bake, i);
        for (int i = 0; i < 3; i++) {
            const int exitCode = bakes[size_t(i)].get();
            done += exitCode == 0;
            const std::string err = contents(folder.path() / ("err" + std::to_string(i) + ".txt"));
            CAPTURE(err);
            if (exitCode != 0) CHECK_EQ(exitCode, 1);
            if (exitCode != 0) CHECK(says(err, "another bake"));
        }
        CHECK((contents(folder.path() / "out.relume") == whole));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume.checkpoint"));
    }
    CHECK_GE(done, 3);
}

TEST_CASE("surroundings: a bake that is replaced while it is drawn is drawn as it was, or as it is") {
    const MeshFolder folder;
    const std::array<std::string, 2> bakes = {baked(folder, "-m clay"), baked(folder, "-m gold")};
    std::vector<std::string> pictures;
    const auto draw = [&] {
        const Outcome render = runRelume(folder, kDraw + "out.png", kNoThreads);
        REQUIRE_MESSAGE(render.exitCode == 0, render.err);
        return contents(folder.path() / "out.png");
    };
    for (const std::string& bake : bakes) {
        folder.write("in.relume", bake);
        pictures.push_back(draw());
    }
    REQUIRE((pictures[0] != pictures[1]));
    std::atomic<bool> isOver = false;
    const auto replacing = std::async(std::launch::async, [&] {
        for (size_t i = 0; !isOver; i++) folder.write("in.relume", bakes[i % 2]);
    });
    for (int i = 0; i < 8; i++) {
        const std::string picture = draw();
        CHECK((picture == pictures[0] || picture == pictures[1]));
    }
    isOver = true;
}

TEST_CASE("surroundings: a home that cannot be written changes nothing") {
    const MeshFolder folder;
    const std::string whole = baked(folder, "-m clay");
    const Outcome bake =
        runRelume(folder, kFlatBake + "-m clay -o out.relume",
                  std::string(kNoThreads) + " HOME=/proc XDG_CACHE_HOME=/proc/cache TMPDIR=/proc");
    CHECK_MESSAGE(bake.exitCode == 0, bake.err);
    CHECK((contents(folder.path() / "out.relume") == whole));
}

TEST_CASE("surroundings: names of files are any bytes") {
    const MeshFolder folder;
    const std::string odd = "a\nb\"'\xff $x;&";
    const std::filesystem::path inside = folder.path() / odd;
    std::filesystem::create_directory(inside);
    std::filesystem::rename(folder.path() / "mesh.obj", inside / (odd + ".obj"));
    const auto name = [&](const char* ending) { return quoted(odd + "/" + odd + ending); };
    const auto run = [&](const std::string& arguments) {
        const Outcome outcome = runRelume(folder, arguments, kNoThreads);
        CHECK_MESSAGE(outcome.exitCode == 0, outcome.err);
        return outcome;
    };
    std::string command = kFlatBake + "-m clay --keep-visibility -o " + name(".relume") + " --timings " +
                          name(".json") + " --json";
    command.replace(command.find("mesh.obj"), 8, name(".obj"));
    std::istringstream events(run(command).out);
    for (std::string line; std::getline(events, line);) CHECK(nlohmann::json::accept(line));
    run("info " + name(".relume"));
    CHECK(nlohmann::json::accept(run("info --json " + name(".relume")).out));
    run("render " + name(".relume") + " --size 16x12 -o " + name(".png") + " --timings " + name(".json"));
    run("reference " + name(".relume") + " --size 16x12 --rays 1 -o " + name(".exr"));
    run("rebake " + name(".relume") + " -m gold -q -o " + name(".relume"));
    CHECK(std::filesystem::file_size(inside / (odd + ".png")) > 0);
    const Outcome missing =
        runRelume(folder, "render " + name(".none.relume") + " -o " + name(".png"), kNoThreads);
    CHECK_EQ(missing.exitCode, 1);
    CHECK(says(missing.err, odd + ".none.relume"));
}

TEST_CASE("surroundings: at every write of a picture the disk can be full, or the program killed") {
    const MeshFolder folder;
    folder.write("in.relume", baked(folder, "-m clay"));
    for (const std::string output : {"out.png", "out.exr"})
        for (const std::string kind : {"full", "short", "kill"}) {
            CAPTURE(output);
            CAPTURE(kind);
            const auto draw = [&](int call) {
                folder.write(output, "precious");
                return runRelume(folder, kDraw + output + " --distant-light 0,45",
                                 std::string(kNoThreads) +
                                     " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_PATH=" + output +
                                     " RELUME_FAULT=" + kind + " RELUME_FAULT_CALL=" + std::to_string(call));
            };
            int call = 1;
            for (;; call += faultStride(2)) {
                CAPTURE(call);
                const Outcome outcome = draw(call);
                if (outcome.exitCode == 0) break;
                CHECK_EQ(outcome.exitCode, kind == "kill" ? 137 : 1);
                CHECK_EQ(contents(folder.path() / output), "precious");
                if (kind == "kill") continue;
                CHECK(says(outcome.err, output));
                for (const auto& file : std::filesystem::directory_iterator(folder.path()))
                    CHECK_FALSE(file.path().filename().string().starts_with(output + "."));
            }
            CHECK_GT(call, 3); // a write, a flush and a rename
            CHECK_NE(contents(folder.path() / output), "precious");
        }
}

TEST_CASE("surroundings: a file that cannot be opened or read to its end is an error that names it") {
    const MeshFolder folder;
    folder.write("in.relume", baked(folder, "-m clay"));
    folder.write("scene.json", R"({"parts": [{"mesh": "mesh.obj", "material": "tin.json"}]})");
    folder.write("tin.json", R"({"model": "plastic"})");
    folder.write("lamp.json", R"({"distant": [{"azimuth": 0, "elevation": 45, "irradiance": [1, 1, 1]}]})");
    succeed(folder, "render in.relume -o room.exr --size 16x8");
    const std::string bake = "bake scene.json" + kFlatBake.substr(kFlatBake.find(" --")) + "-o out.relume",
                      draw = kDraw + "out.png ";
    const std::pair<std::string, std::string> readings[] = {{"scene.json", bake},
                                                            {"mesh.obj", bake},
                                                            {"tin.json", bake},
                                                            {"in.relume", draw + "--distant-light 0,45"},
                                                            {"room.exr", draw + "-e room.exr"},
                                                            {"lamp.json", draw + "--light lamp.json"}};
    for (const auto& [file, command] : readings) {
        CAPTURE_BINDING(command);
        CAPTURE_BINDING(file);
        const std::string output = command.starts_with("bake") ? "out.relume" : "out.png";
        int call = 1;
        for (;; call++) {
            CAPTURE(call);
            folder.write(output, "precious");
            const Outcome outcome = runRelume(
                folder, command,
                std::string(kNoThreads) + " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_PATH=" + file +
                    " RELUME_FAULT=unreadable RELUME_FAULT_CALL=" + std::to_string(call));
            CAPTURE(outcome.err);
            if (outcome.exitCode == 0) break;
            REQUIRE_EQ(outcome.exitCode, 1);
            CHECK(says(outcome.err, "error: "));
            REQUIRE(says(outcome.err, file));
            REQUIRE(says(outcome.err, "cannot be read"));
            CHECK_EQ(contents(folder.path() / output), "precious");
        }
        CHECK_GT(call, 2);
    }
}

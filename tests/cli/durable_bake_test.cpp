// A bake that is killed, stopped, starved of disk, memory or threads: it goes on, to the same bytes.
#include "tests/support/capture_binding.h"
#include "tests/support/run_relume.h"

#include <chrono>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <random>
#include <spawn.h>
#include <sys/file.h>
#include <thread>

using namespace relume::test;

extern char** environ;

namespace {

// A triangle over a ground: parts of one and of three blocks, little work each.
std::string bakeCommand(int groundQuads) {
    return "bake mesh.obj --ground --ground-tessellation " + std::to_string(groundQuads) +
           " --refine off -K 2 -N 8 --layout rows --bounces 0 --visibility-size 64 --face-size 32 --map-size "
           "8 -q -o "
           "out.relume ";
}
const std::string kTriangleBake = bakeCommand(12);

std::string faults(const std::string& kind, int call) {
    return std::string(kNoThreads) +
           " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_PATH=out.relume RELUME_FAULT=" + kind +
           " RELUME_FAULT_CALL=" + std::to_string(call);
}

// The bytes of a bake that nothing disturbed.
const std::string& undisturbed() {
    static const std::string bytes = [] {
        const BakeFolder folder;
        const Outcome bake = runRelume(folder, kTriangleBake, kNoThreads);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
        return contents(folder.path() / "out.relume");
    }();
    return bytes;
}

// That a bake goes on to the right bytes and leaves nothing beside them.
void checkFinishes(const BakeFolder& folder) {
    const Outcome bake = runRelume(folder, kTriangleBake, kNoThreads);
    CAPTURE(bake.err);
    REQUIRE_EQ(bake.exitCode, 0);
    CHECK(contents(folder.path() / "out.relume") == undisturbed());
    for (const auto& file : std::filesystem::directory_iterator(folder.path()))
        CHECK_MESSAGE(std::string("mesh.obj out.relume out.txt err.txt").find(file.path().filename()) !=
                          std::string::npos,
                      file.path());
}

// Starts a bake in the folder and gives its process.
pid_t startBake(const BakeFolder& folder, const std::string& bake) {
    const std::string command = "cd '" + folder.path().string() + "' && " + kNoThreads +
                                " exec '" RELUME_PROGRAM "' " + bake + " >out.txt 2>err.txt </dev/null";
    const char* arguments[] = {"sh", "-c", command.c_str(), nullptr};
    pid_t process = 0;
    REQUIRE_EQ(posix_spawn(&process, "/bin/sh", nullptr, nullptr, const_cast<char**>(arguments), environ), 0);
    return process;
}

int wait(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return status;
}

} // namespace

TEST_CASE("durable bake: killed at random instants, it resumes to the same bytes") {
    undisturbed(); // the driver caches shaders: the next takes as long as all that follow
    const BakeFolder timed;
    const auto start = std::chrono::steady_clock::now();
    checkFinishes(timed);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    std::mt19937 random(1);
    double longest = whole.count();
    const BakeFolder folder;
    std::ofstream(folder.path() / "out.relume") << "precious";
    const int kills = std::getenv("RELUME_EVERY_FAULT") ? 25 : 8;
    int killed = 0;
    for (int attempt = 0; attempt < 250 && killed < kills; attempt++) {
        const pid_t process = startBake(folder, kTriangleBake);
        std::uniform_real_distribution<double> instant(0, longest);
        std::this_thread::sleep_for(std::chrono::duration<double>(instant(random)));
        kill(process, SIGKILL);
        if (WIFSIGNALED(wait(process)))
            killed++;
        else
            longest *= 0.95; // the machine has got faster since
        const std::string output = contents(folder.path() / "out.relume");
        CHECK((output == "precious" || output == undisturbed()));
        // Once whole, all begins again.
        if (output == undisturbed()) {
            checkFinishes(folder);
            std::ofstream(folder.path() / "out.relume") << "precious";
        }
    }
    CHECK_EQ(killed, kills);
    checkFinishes(folder);
}

TEST_CASE("durable bake: at every write it can be killed, run out of disk or fall short") {
    // Without RELUME_EVERY_FAULT every write fails in one of the three ways.
    const int stride = faultStride(3);
    int first = 1;
    for (const std::string kind : {"kill", "full", "short"}) {
        CAPTURE(kind);
        int call = stride == 1 ? 1 : first++;
        for (;; call += stride) {
            CAPTURE(call);
            const BakeFolder folder;
            std::ofstream(folder.path() / "out.relume") << "precious";
            const Outcome bake = runRelume(folder, kTriangleBake, faults(kind, call));
            if (bake.exitCode == 0) {
                CHECK(contents(folder.path() / "out.relume") == undisturbed());
                break;
            }
            CAPTURE(bake.err);
            CHECK_EQ(bake.exitCode, kind == "kill" ? 137 : 1);
            const std::string output = contents(folder.path() / "out.relume");
            CHECK((output == "precious" || output == undisturbed()));
            if (kind != "kill") CHECK(says(bake.err, "out.relume"));
            // A bake that ends with an error leaves much the same at every write.
            if (kind == "kill" || call % (3 * stride) < stride) checkFinishes(folder);
        }
        // A checkpoint's header, four blocks; the file's header, table and chunks, a flush and a rename.
        CHECK_GT(call, 22);
    }
}

TEST_CASE("durable bake: blocks that are kept are not baked again, whatever was torn behind them") {
    const BakeFolder folder;
    const auto checkpoint = folder.path() / "out.relume.checkpoint";
    REQUIRE_EQ(runRelume(folder, kTriangleBake, faults("kill", 6)).exitCode, 137);
    const std::string kept = contents(checkpoint);
    const auto doneOf = [&] {
        const Outcome bake = runRelume(folder, kTriangleBake + "--json", kNoThreads);
        REQUIRE_EQ(bake.exitCode, 0);
        CHECK(contents(folder.path() / "out.relume") == undisturbed());
        std::istringstream lines(bake.out);
        for (std::string line; std::getline(lines, line);) {
            const auto event = nlohmann::json::parse(line);
            if (event["event"] == "start") return event["done"].get<int>();
        }
        return -1;
    };
    const int all = doneOf();
    CHECK_EQ(all, 3 + 2 * 64); // the header and three blocks were written
    std::mt19937 random(2);
    for (int i = 0; i < 6; i++) {
        std::string damaged = kept;
        if (i < 3)
            damaged.resize(random() % kept.size());
        else
            damaged[60 + random() % (kept.size() - 60)] ^= char(1 << random() % 8);
        std::ofstream(checkpoint, std::ios::binary) << damaged;
        const int done = doneOf();
        CHECK_LT(done, all);
        CHECK_EQ(done % 64, done == 0 ? 0 : 3);
    }
    std::ofstream(checkpoint, std::ios::binary)
        << kept << "some bytes that are no record, and enough of them";
    CHECK_EQ(doneOf(), all);
}

TEST_CASE("durable bake: a checkpoint of other options is said to be dropped, another file is left alone") {
    const BakeFolder folder;
    const auto checkpoint = folder.path() / "out.relume.checkpoint";
    REQUIRE_EQ(runRelume(folder, kTriangleBake + "-m clay", faults("kill", 6)).exitCode, 137);
    const Outcome other = runRelume(folder, kTriangleBake, kNoThreads);
    CHECK_EQ(other.exitCode, 0);
    CHECK(says(other.err, "out.relume.checkpoint"));
    CHECK(says(other.err, "starting over"));
    CHECK(contents(folder.path() / "out.relume") == undisturbed());
    std::ofstream(checkpoint) << "somebody's notes";
    const Outcome refused = runRelume(folder, kTriangleBake, kNoThreads);
    CHECK_EQ(refused.exitCode, 1);
    CHECK(says(refused.err, "out.relume.checkpoint"));
    CHECK_EQ(contents(checkpoint), "somebody's notes");
}

TEST_CASE("durable bake: two bakes to one output are one too many") {
    const BakeFolder folder;
    const auto checkpoint = folder.path() / "out.relume.checkpoint";
    const int file = open(checkpoint.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    REQUIRE_EQ(flock(file, LOCK_EX), 0);
    const Outcome second = runRelume(folder, kTriangleBake, kNoThreads);
    CHECK_EQ(second.exitCode, 1);
    CHECK(says(second.err, "another bake"));
    close(file);
    checkFinishes(folder);
}

TEST_CASE("durable bake: SIGINT and SIGTERM stop it with the batch at hand, and it resumes") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const BakeFolder folder;
        // Enough vertices, in batches small enough, not to be done with the one at hand.
        const std::string command = bakeCommand(60) + "--memory 3M --json";
        const int vertices = 3 + 61 * 61;
        const pid_t process = startBake(folder, command);
        for (int i = 0; i < 2000 && !says(contents(folder.path() / "out.txt"), "\"progress\""); i++)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        kill(process, signal);
        const int status = wait(process);
        REQUIRE(WIFEXITED(status));
        CHECK_EQ(WEXITSTATUS(status), 128 + signal);
        CHECK(says(contents(folder.path() / "err.txt"), "same command"));
        const std::string events = contents(folder.path() / "out.txt");
        const auto last = nlohmann::json::parse(events.substr(events.rfind('\n', events.size() - 2) + 1));
        CHECK_EQ(last["event"], "stopped");
        CHECK_GE(last["done"].get<int>(), 3);
        CHECK_LT(last["done"].get<int>(), vertices);
        CHECK(std::filesystem::exists(folder.path() / "out.relume.checkpoint"));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume"));
        const Outcome resumed = runRelume(folder, command, kNoThreads);
        CHECK_EQ(resumed.exitCode, 0);
        CHECK(says(resumed.out,
                   "\"vertices\":" + std::to_string(vertices) + ",\"done\":" + last["done"].dump() + "}"));
    }
}

TEST_CASE("durable bake: batches, threads and a device out of memory do not show in the bytes") {
    for (const auto& [arguments, environment, warning] : std::vector<std::array<std::string, 3>>{
             {"--memory 3M", kNoThreads, ""},
             {"--memory 20M --threads 2", "", ""},
             {"--threads 1", "", ""},
             {"",
              std::string(kNoThreads) + " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_VULKAN=device-memory "
                                        "RELUME_FAULT_VULKAN_FUNCTION=vkQueueSubmit2 "
                                        "RELUME_FAULT_VULKAN_CALL=9",
              "instead of 64"}}) {
        CAPTURE_BINDING(arguments);
        const BakeFolder folder;
        const Outcome bake = runRelume(folder, kTriangleBake + arguments, environment);
        CAPTURE(bake.err);
        REQUIRE_EQ(bake.exitCode, 0);
        CHECK(says(bake.err, warning));
        CHECK(contents(folder.path() / "out.relume") == undisturbed());
    }
    const BakeFolder folder;
    const Outcome little = runRelume(folder, kTriangleBake + "--memory 10k", kNoThreads);
    CHECK_EQ(little.exitCode, 2);
    CHECK(says(little.err, "--memory"));
}

TEST_CASE("durable bake: bases go on to the same bytes, sample or not") {
    // Parts of one and of 1681 vertices: of the second, not all are of the sample.
    const std::string bake = "bake mesh.obj --ground --ground-tessellation 40 --refine off -K 2 -N 40 "
                             "--bounces 0 --visibility-size 64 "
                             "--face-size 32 --map-size 8 -q -o out.relume --error 0.2";
    const BakeFolder undisturbed;
    REQUIRE_EQ(runRelume(undisturbed, bake, kNoThreads).exitCode, 0);
    const std::string whole = contents(undisturbed.path() / "out.relume");
    // In the header, its sync, the scale, the sample's blocks and those that follow.
    for (int call = 1; call < 13; call += call < 5 ? 1 : 3) {
        CAPTURE(call);
        const BakeFolder folder;
        REQUIRE_EQ(runRelume(folder, bake, faults("kill", call)).exitCode, 137);
        const Outcome resumed = runRelume(folder, bake + " --json", kNoThreads);
        REQUIRE_MESSAGE(resumed.exitCode == 0, resumed.err);
        // Once the scale is kept, no sample is baked again.
        CHECK_EQ(says(resumed.out, "\"stage\":\"sample\""), call <= 3);
        CHECK(contents(folder.path() / "out.relume") == whole);
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.relume.checkpoint"));
    }
    const BakeFolder folder;
    for (const std::string limits : {" --memory 3M", " --threads 1", " --threads 2"}) {
        const Outcome limited = runRelume(folder, bake + limits, limits == " --memory 3M" ? kNoThreads : "");
        REQUIRE_MESSAGE(limited.exitCode == 0, limited.err);
        CHECK(contents(folder.path() / "out.relume") == whole);
        std::filesystem::remove(folder.path() / "out.relume");
    }
}

// Surroundings that the viewer does not choose: calls of Vulkan that fail, folders that cannot be written,
// and a full disk.
#include "tests/support/capture_binding.h"
#include "tests/support/viewer_session.h"

#include <chrono>
#include <csignal>
#include <future>
#include <thread>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

constexpr const char* kFaults = "LD_PRELOAD='" RELUME_FAULTS "' ";

// As fast as the viewer can draw.
const json kPlain = {{"set", {{"samples", 1}, {"residual", false}, {"background", "none"}}}};

// Counts what became of the calls that failed, one in each run. `told` counts runs in which the viewer said
// why an image is missing and went on.
struct Tally {
    int calls = 0, failed = 0, recovered = 0, told = 0, refused = 0;
};

// A session that shows a bake, and that in a smaller window, as fast as the viewer can. One call of Vulkan
// fails in each run.
class Sweep {
  public:
    Sweep() {
        const Outcome whole = run("");
        REQUIRE_MESSAGE(whole.exitCode == 0, whole.err);
        REQUIRE(isQuiet(whole.err));
        for (const char* image : kImages) mWhole.push_back(mSession.bytes(image));
    }

    // Fails every `stride`-th call of Vulkan (faultStride()), of all functions or of one. The number of
    // frames, and with it of calls, differs a little from run to run. What a failed call leaves is null,
    // since GLFW and Dear ImGui use it.
    Tally fail(const std::string& result, int stride, const std::string& function = "") {
        return sweep("RELUME_FAULT_VULKAN_NULL=1 RELUME_FAULT_VULKAN=" + result +
                         (function.empty() ? "" : " RELUME_FAULT_VULKAN_FUNCTION=" + function) +
                         " RELUME_FAULT_VULKAN_CALL=",
                     result, 1, faultStride(stride));
    }

    // Fails the first allocation of every `stride`-th place in the program, but of the first ones, which make
    // variables before main().
    Tally failMemory(int stride) {
        return sweep("RELUME_FAULT_MEMORY_PLACES=1 RELUME_FAULT_MEMORY_CALL=", "memory", 60,
                     faultStride(stride));
    }

  private:
    static constexpr const char* kImages[] = {"first.exr", "small.exr"};

    // Fails calls by a variable of the environment that ends in the number of one.
    Tally sweep(const std::string& environment, const std::string& kind, int first, int stride) {
        const auto faulty = [&](int call) { return run(kFaults + environment + std::to_string(call)); };
        Tally tally;
        const std::string said = faulty(0).err;
        const size_t last = said.rfind("faults: ");
        REQUIRE_MESSAGE(last != std::string::npos, said);
        REQUIRE_EQ(std::sscanf(said.c_str() + last, "faults: %d ", &tally.calls), 1);
        for (int call = first; call <= tally.calls; call += stride) {
            CAPTURE(environment);
            CAPTURE(call);
            check(faulty(call), kind, tally);
        }
        MESSAGE(environment << ": " << tally.calls << " calls, " << tally.failed << " failed, "
                            << tally.recovered << " recovered, " << tally.told << " told, " << tally.refused
                            << " errors");
        return tally;
    }

    Outcome run(const std::string& environment) {
        for (const char* image : kImages) std::filesystem::remove(mSession.path(image));
        return mSession.replay({kPlain,
                                {{"wait", "settled"}},
                                {{"screenshot", "first.exr"}},
                                {{"frames", 3}}, // one may fail
                                {{"resize", {400, 300}}},
                                {{"wait", "settled"}},
                                {{"screenshot", "small.exr"}},
                                {{"frames", 3}},
                                {{"quit", true}}},
                               "--no-vsync ring.relume room.exr", environment);
    }

    void check(const Outcome& outcome, const std::string& kind, Tally& tally) {
        CAPTURE(outcome.err);
        CHECK_FALSE(says(outcome.err, "validation:"));
        const size_t fault = says(outcome.err, " fails\n") ? outcome.err.find("faults: ") : std::string::npos;
        char function[64] = "";
        if (fault != std::string::npos)
            REQUIRE_EQ(std::sscanf(outcome.err.c_str() + fault, "faults: %63s fails", function), 1);
        else // so many calls there were not
            CHECK(isQuiet(outcome.err));
        const bool isRefused = outcome.exitCode != 0, isTold = !isRefused && says(outcome.err, "error: ");
        tally.failed += fault != std::string::npos;
        (isRefused ? tally.refused : isTold ? tally.told : tally.recovered) += fault != std::string::npos;
        if (outcome.exitCode == 4) { // GLFW looks for what the display needs
            CHECK_EQ(std::string(function), "vkEnumerateInstanceExtensionProperties");
            CHECK(says(outcome.err, "error: this display cannot show what Vulkan draws"));
        } else if (isRefused || isTold) {
            if (isRefused) CHECK_EQ(outcome.exitCode, 1);
            if (kind == "memory") {
                CHECK(says(outcome.err, "out of memory"));
                return;
            }
            // After a loss the first call to fail may be a wait whose result nobody checks.
            const bool isNamed = says(outcome.err, std::string("error: ") + function);
            CHECK((isNamed || says(outcome.err, "error: Dear ImGui") || kind == "lost"));
            CHECK(says(outcome.err, kind == "lost"            ? "the Vulkan device was lost"
                                    : kind == "device-memory" ? "too little free memory"
                                                              : "ErrorSurfaceLostKHR"));
            CHECK(says(outcome.err, kind == "device-memory" ? "close other programs" : "--device"));
        } else {
            for (size_t i = 0; i < std::size(kImages); i++) CHECK((mSession.bytes(kImages[i]) == mWhole[i]));
        }
    }

    ViewerSession mSession;
    std::vector<std::string> mWhole; // the images of a run that nothing disturbs
};

} // namespace

TEST_CASE("viewer surroundings: lost images and surfaces are made again, and a lost device is an error") {
    Sweep sweep;
    const Tally outOfDate = sweep.fail("out-of-date", 14);
    CHECK_GT(outOfDate.failed, 2);
    CHECK_EQ(outOfDate.recovered, outOfDate.failed);
    const Tally surface = sweep.fail("surface-lost", 19);
    CHECK_GT(surface.recovered, 1);
    CHECK_EQ(surface.told, 0);
    CHECK_GT(sweep.fail("lost", 97).refused, 1);
    CHECK_GT(sweep.fail("device-memory", 401).refused, 1);
    sweep.fail("device-memory", 61, "vkWaitForFences");
}

TEST_CASE("viewer surroundings: memory that runs out is an error, or costs a step") {
    Sweep sweep;
    CHECK_GT(sweep.failMemory(127).refused, 1);
}

TEST_CASE("viewer surroundings: without a writable home a bake is shown, with a warning") {
    ViewerSession session;
    const std::string nowhere = "HOME=/proc XDG_CACHE_HOME=/proc/cache XDG_STATE_HOME=/proc/state";
    const json script = {{{"wait", "settled"}}, {{"screenshot", "look.exr"}}, {{"quit", true}}};
    REQUIRE_EQ(session.replay(script, "ring.relume").exitCode, 0);
    const std::string whole = session.bytes("look.exr");
    const Outcome shown = session.replay(script, "ring.relume", nowhere);
    CAPTURE(shown.err);
    CHECK_EQ(shown.exitCode, 0);
    CHECK(isQuiet(shown.err));
    CHECK(says(shown.err, "/proc/cache/relume: cannot be made"));
    CHECK(says(shown.err, "XDG_CACHE_HOME"));
    CHECK((session.bytes("look.exr") == whole));
    // There is no place for the bake of a mesh.
    const Outcome refused = session.replay(script, "ring.obj", nowhere);
    CHECK_EQ(refused.exitCode, 1);
    CHECK(says(refused.err, "error: /proc/cache/relume: cannot be made"));
}

TEST_CASE("viewer surroundings: settings that cannot be written are a warning") {
    ViewerSession session;
    // The first frame says so: its image is out of date. A script would remember nothing.
    auto viewer = std::async(std::launch::async, [&] {
        return session.view("ring.relume", "sh -c 'echo $$ >pid.txt; exec env \"$@\"' sh " +
                                               std::string(kFaults) +
                                               "RELUME_FAULT_VULKAN=out-of-date "
                                               "RELUME_FAULT_VULKAN_FUNCTION=vkQueuePresentKHR "
                                               "RELUME_FAULT_VULKAN_CALL=1 XDG_STATE_HOME=/proc/state");
    });
    const auto isOver = [&] {
        return viewer.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready;
    };
    while (!says(session.bytes("err.txt"), "vkQueuePresentKHR fails"))
        if (isOver()) break;
    kill(std::stoi(session.bytes("pid.txt")), SIGINT);
    const Outcome outcome = viewer.get();
    CAPTURE(outcome.err);
    CHECK_EQ(outcome.exitCode, 130);
    CHECK(says(outcome.err, "settings are not remembered: /proc/state/relume: cannot be made"));
}

TEST_CASE(
    "viewer surroundings: a disk that is full at any write of a picture or session leaves the old file") {
    ViewerSession session;
    const auto namesOf = [&](const std::string& ending) {
        std::vector<std::string> names;
        for (const auto& file : std::filesystem::directory_iterator(session.folder().path()))
            if (says(file.path().filename(), ending)) names.push_back(file.path().filename());
        return names;
    };
    const std::vector<std::pair<std::string, json>> outputs = {{"look.png", {{"screenshot", "look.png"}}},
                                                               {"look.exr", {{"screenshot", "look.exr"}}},
                                                               {".session.json", {{"key", "ctrl+S"}}}};
    int first = 0;
    for (const auto& [output, step] : outputs) {
        CAPTURE_BINDING(output);
        first++; // each output begins with another write
        const bool isNamed = output[0] != '.';
        int call = faultStride(first);
        for (;; call += faultStride(3)) {
            CAPTURE(call);
            if (isNamed) session.folder().write(output, "precious");
            const Outcome outcome =
                session.replay({kPlain, {{"wait", "shown"}}, step, {{"frames", 2}}, {{"quit", true}}},
                               "ring.relume room.exr",
                               kFaults + ("RELUME_FAULT=full RELUME_FAULT_PATH=" + output) +
                                   " RELUME_FAULT_CALL=" + std::to_string(call));
            CAPTURE(outcome.err);
            REQUIRE_EQ(outcome.exitCode, 0); // it goes on
            if (isQuiet(outcome.err)) break;
            CHECK(says(outcome.err, "error: "));
            CHECK(says(outcome.err, output));
            CHECK_FALSE(says(outcome.err, "is written"));
            CHECK_EQ(namesOf(output).size(), isNamed ? 1u : 0u);
            if (isNamed) CHECK_EQ(session.bytes(output), "precious");
        }
        CHECK_GT(call, 3); // a write, a flush and a rename
        CHECK_EQ(namesOf(output).size(), 1u);
        if (isNamed) CHECK_NE(session.bytes(output), "precious");
    }
    // A window that ends by itself cannot show the error, so the program exits with it.
    session.folder().write("look.png", "precious");
    const Outcome outcome = session.view("ring.relume --exit-frame 1 --screenshot look.png",
                                         kFaults + std::string("RELUME_FAULT=full RELUME_FAULT_PATH=look.png "
                                                               "RELUME_FAULT_CALL=1"));
    CAPTURE(outcome.err);
    CHECK_EQ(outcome.exitCode, 1);
    CHECK(says(outcome.err, "look.png"));
    CHECK_EQ(session.bytes("look.png"), "precious");
}

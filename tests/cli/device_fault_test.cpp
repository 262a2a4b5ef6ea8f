// Every call of Vulkan that may fail does so once: the program goes on to the same output, or says what
// failed and what to do, and leaves the output that was there.
#include "engine/import/image_file.h"
#include "tests/support/run_relume.h"

#include <doctest/doctest.h>
#include <set>

using namespace relume;
using namespace relume::test;

namespace {

// A command that reads in.relume or mesh.obj, and the file that it writes. Validation tells of what is done
// to objects that were not made, and of those that are left.
struct Command {
    std::string arguments, output;
};

const std::string kSmallBake =
    "bake mesh.obj -m clay --refine off -K 1 -N 8 --visibility-size 64 --face-size 32 "
    "--map-size 8 -q --validation core,sync -o out.relume ";
const Command kFaultyBake{kSmallBake + "--bounces 0 --layout rows", "out.relume"};
const Command kBounces{kSmallBake + "--bounces 1 --ground --ground-tessellation 3", "out.relume"};
const Command kPicture{"render in.relume -e room.exr --size 16x12 --validation core,sync -o out.png",
                       "out.png"};

// Counts what became of the calls that failed, one in each run.
struct Tally {
    int calls = 0, failed = 0, recovered = 0, refused = 0;
};

struct FaultFolder : TemporaryFolder {
    FaultFolder() {
        write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
        Image room(16, 8);
        for (vec4& pixel : room.pixels) pixel = vec4(1);
        writeExr(path() / "room.exr", room);
    }
};

// Fails one call in each run, and of all calls every `stride`-th (faultStride()).
class Sweep {
  public:
    explicit Sweep(const Command& command) : mCommand(command) {
        const Outcome input = runRelume(mFolder, kFaultyBake.arguments, kNoThreads);
        REQUIRE_MESSAGE(input.exitCode == 0, input.err);
        std::filesystem::rename(mFolder.path() / kFaultyBake.output, mFolder.path() / "in.relume");
        const Outcome whole = runRelume(mFolder, mCommand.arguments, kNoThreads);
        REQUIRE_MESSAGE(whole.exitCode == 0, whole.err);
        mWhole = contents(output());
    }

    // Fails every `stride`-th call of `function`, or of any function if it is empty.
    Tally run(const std::string& result, int stride, const std::string& function = "") {
        mFunction = function;
        stride = faultStride(stride);
        Tally tally;
        const std::string said = faulty(result, 0).err;
        REQUIRE_EQ(std::sscanf(said.c_str() + said.rfind("faults: "), "faults: %d calls", &tally.calls), 1);
        for (int call = 1; call <= tally.calls; call += stride) {
            CAPTURE(result);
            CAPTURE(call);
            fail(result, call, tally);
        }
        MESSAGE(mCommand.arguments << ", " << result << ": " << tally.calls << " calls, " << tally.failed
                                   << " failed, " << tally.recovered << " recovered, " << tally.refused
                                   << " errors");
        return tally;
    }

  private:
    std::filesystem::path output() const { return mFolder.path() / mCommand.output; }

    Outcome faulty(const std::string& result, int call) const {
        const std::string only = mFunction.empty() ? "" : " RELUME_FAULT_VULKAN_FUNCTION=" + mFunction;
        return runRelume(mFolder, mCommand.arguments,
                         std::string("timeout 100 env ") + kNoThreads +
                             " LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_VULKAN=" + result +
                             " RELUME_FAULT_VULKAN_CALL=" + std::to_string(call) + only);
    }

    void fail(const std::string& result, int call, Tally& tally) {
        std::ofstream(output(), std::ios::binary) << "precious";
        const Outcome outcome = faulty(result, call);
        CAPTURE(outcome.err);
        char function[64] = "";
        const size_t fault = outcome.err.find("faults: vk");
        REQUIRE_NE(fault, std::string::npos);
        REQUIRE_EQ(std::sscanf(outcome.err.c_str() + fault, "faults: %63s fails", function), 1);
        CHECK_FALSE(says(outcome.err, "validation:"));
        tally.failed++;
        const bool isRefused = outcome.exitCode != 0;
        (isRefused ? tally.refused : tally.recovered)++;
        if (isRefused) {
            CHECK_EQ(outcome.exitCode, 1);
            CHECK(says(outcome.err, std::string("error: ") + function));
            CHECK(says(outcome.err, result == "lost" ? "--device" : "close other programs"));
            CHECK_EQ(contents(output()), "precious");
            const bool isBegun = std::filesystem::exists(output().string() + ".checkpoint");
            if (isBegun) CHECK_EQ(runRelume(mFolder, mCommand.arguments, kNoThreads).exitCode, 0);
            if (isBegun) CHECK((contents(output()) == mWhole));
        } else {
            CHECK((contents(output()) == mWhole));
        }
        std::set<std::string> left;
        for (const auto& file : std::filesystem::directory_iterator(mFolder.path()))
            left.insert(file.path().filename());
        CHECK((left == std::set<std::string>{"mesh.obj", "room.exr", "in.relume", mCommand.output, "out.txt",
                                             "err.txt"}));
    }

    const Command& mCommand;
    FaultFolder mFolder;
    std::string mFunction;
    std::string mWhole; // the output of a run that nothing disturbs
};

} // namespace

TEST_CASE("device faults: a bake goes on, or ends with an error and can be resumed") {
    Sweep sweep(kFaultyBake);
    const Tally memory = sweep.run("device-memory", 9);
    CHECK_GT(memory.calls, 100);
    CHECK_GT(memory.recovered, 8);
    CHECK_GT(memory.refused, 0);
    sweep.run("host-memory", 23);
    CHECK_LE(sweep.run("lost", 3).recovered, 1); // the wait at the end
}

TEST_CASE("device faults: a bake with bounces goes on, or ends with an error and can be resumed") {
    Sweep sweep(kBounces);
    sweep.run("device-memory", 97);
    sweep.run("host-memory", 101);
    sweep.run("lost", 13);
}

TEST_CASE("device faults: a picture is drawn whole or not at all") {
    Sweep sweep(kPicture);
    CHECK_GT(sweep.run("device-memory", 4, "vkAllocateMemory").refused, 1);
    sweep.run("device-memory", 97);
    sweep.run("host-memory", 101);
    sweep.run("lost", 13);
}

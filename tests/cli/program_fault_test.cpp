// Every call of Vulkan that may fail, and every allocation, does so once: the program goes on to the same
// output, or says what failed and what to do, and leaves the output that was there.
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

// A kind of calls that fail in runs of a command: `environment` chooses a kind of calls for the library of
// faults, `counter` is the variable that chooses one of them. A refusal says `advice`, and after "error: "
// what failed: `named`, or the function of Vulkan.
struct Fault {
    std::string environment, counter, advice, named;
};

Fault vulkanFault(const std::string& result, const std::string& function = "") {
    return {"RELUME_FAULT_VULKAN=" + result +
                (function.empty() ? "" : " RELUME_FAULT_VULKAN_FUNCTION=" + function),
            "RELUME_FAULT_VULKAN_CALL", result == "lost" ? "--device" : "close other programs", ""};
}

Fault memoryFault(int leastBytes) {
    return {"RELUME_FAULT_MEMORY_BYTES=" + std::to_string(leastBytes), "RELUME_FAULT_MEMORY_CALL",
            "close other programs", "out of memory"};
}

// Runs relume while an allocation fails, none if `call` is 0.
Outcome runMemoryFault(const TemporaryFolder& folder, const std::string& arguments, int call) {
    return runRelume(folder, arguments,
                     "LD_PRELOAD='" RELUME_FAULTS "' RELUME_FAULT_MEMORY_CALL=" + std::to_string(call));
}

// Returns the number of calls that the library of faults tells of.
int callsOf(const Outcome& outcome) {
    const size_t last = outcome.err.rfind("faults: ");
    REQUIRE_MESSAGE(last != std::string::npos, outcome.err);
    int calls = 0;
    REQUIRE_EQ(std::sscanf(outcome.err.c_str() + last, "faults: %d ", &calls), 1);
    return calls;
}

// Returns how often the program allocates before any command begins: more than half of all times.
int allocationsOfOptions() { return callsOf(runMemoryFault(FaultFolder(), "--version", 0)); }

// Fails one call in each run, and of all calls from the `first` on every `stride`-th (faultStride()).
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

    Tally run(const Fault& fault, int stride, int first = 1) {
        stride = faultStride(stride);
        Tally tally;
        tally.calls = callsOf(faulty(fault, 0));
        for (int call = first; call <= tally.calls; call += stride) {
            CAPTURE(fault.environment);
            CAPTURE(call);
            fail(fault, call, tally);
        }
        MESSAGE(mCommand.arguments << ", " << fault.environment << ": " << tally.calls << " calls, "
                                   << tally.failed << " failed, " << tally.recovered << " recovered, "
                                   << tally.refused << " errors");
        return tally;
    }

  private:
    std::filesystem::path output() const { return mFolder.path() / mCommand.output; }

    Outcome faulty(const Fault& fault, int call) const {
        return runRelume(mFolder, mCommand.arguments,
                         std::string("timeout 100 env ") + kNoThreads + " LD_PRELOAD='" RELUME_FAULTS "' " +
                             fault.environment + " " + fault.counter + "=" + std::to_string(call));
    }

    void fail(const Fault& fault, int call, Tally& tally) {
        std::ofstream(output(), std::ios::binary) << "precious";
        const Outcome outcome = faulty(fault, call);
        CAPTURE(outcome.err);
        CHECK_FALSE(says(outcome.err, "validation:"));
        const bool isRefused = outcome.exitCode != 0;
        char failed[64] = "";
        const size_t place = outcome.err.find("faults: ");
        REQUIRE_NE(place, std::string::npos);
        REQUIRE_EQ(std::sscanf(outcome.err.c_str() + place, "faults: %63s ", failed), 1);
        if (!says(outcome.err, " fails\n")) { // so many calls there were not, or it was a driver's
            CHECK_FALSE(isRefused);
        } else {
            tally.failed++;
            (isRefused ? tally.refused : tally.recovered)++;
        }
        if (isRefused) {
            CHECK_EQ(outcome.exitCode, 1);
            CHECK(says(outcome.err, "error: " + (fault.named.empty() ? failed : fault.named)));
            CHECK(says(outcome.err, fault.advice));
            const std::string left = contents(output()); // memory may also run out when all is done
            CHECK((left == "precious" || (fault.named == "out of memory" && left == mWhole)));
            const bool isBegun = std::filesystem::exists(output().string() + ".checkpoint");
            if (isBegun) CHECK_EQ(runRelume(mFolder, mCommand.arguments, kNoThreads).exitCode, 0);
            if (isBegun) CHECK((contents(output()) == mWhole));
        } else {
            CHECK((contents(output()) == mWhole));
        }
        std::set<std::string> files;
        for (const auto& file : std::filesystem::directory_iterator(mFolder.path()))
            files.insert(file.path().filename());
        CHECK((files == std::set<std::string>{"mesh.obj", "room.exr", "in.relume", mCommand.output, "out.txt",
                                              "err.txt"}));
    }

    const Command& mCommand;
    FaultFolder mFolder;
    std::string mWhole; // the output of a run that nothing disturbs
};

} // namespace

TEST_CASE("device faults: a bake goes on, or ends with an error and can be resumed") {
    Sweep sweep(kFaultyBake);
    const Tally memory = sweep.run(vulkanFault("device-memory"), 9);
    CHECK_GT(memory.calls, 100);
    CHECK_GT(memory.recovered, 8);
    CHECK_GT(memory.refused, 0);
    sweep.run(vulkanFault("host-memory"), 23);
    CHECK_LE(sweep.run(vulkanFault("lost"), 3).recovered, 1); // the wait at the end
}

TEST_CASE("device faults: a bake with bounces goes on, or ends with an error and can be resumed") {
    Sweep sweep(kBounces);
    sweep.run(vulkanFault("device-memory"), 97);
    sweep.run(vulkanFault("host-memory"), 101);
    sweep.run(vulkanFault("lost"), 13);
}

TEST_CASE("device faults: a picture is drawn whole or not at all") {
    Sweep sweep(kPicture);
    CHECK_GT(sweep.run(vulkanFault("device-memory", "vkAllocateMemory"), 4).refused, 1);
    sweep.run(vulkanFault("device-memory"), 97);
    sweep.run(vulkanFault("host-memory"), 101);
    sweep.run(vulkanFault("lost"), 13);
}

TEST_CASE("memory faults: while its options are made, the program ends with an error") {
    const FaultFolder folder;
    constexpr int kFirst = 60; // those before make variables of the program; there it is aborted
    const int last = callsOf(runMemoryFault(folder, "--version", 0));
    CHECK_GT(last, 1000);
    for (int call = kFirst; call < last; call += faultStride(2003)) {
        CAPTURE(call);
        const Outcome outcome = runMemoryFault(folder, "--version", call);
        if (outcome.exitCode == 0) { // a text that was to be shrunk keeps its memory
            CHECK(says(outcome.out, "relume "));
            continue;
        }
        CHECK_EQ(outcome.exitCode, 1);
        CHECK(says(outcome.err, "error: out of memory; close other programs"));
    }
}

TEST_CASE("memory faults: a bake goes on, or ends with an error and can be resumed") {
    Sweep sweep(kBounces);
    const Tally large = sweep.run(memoryFault(1024), 23, 3);
    CHECK_GT(large.recovered, 1); // in smaller batches
    CHECK_GT(large.refused, 10);
    CHECK_GT(sweep.run(memoryFault(0), 601, allocationsOfOptions()).refused, 5);
}

TEST_CASE("memory faults: a picture is drawn whole or not at all") {
    CHECK_GT(Sweep(kPicture).run(memoryFault(0), 151, allocationsOfOptions()).refused, 5);
}

// Timing captures of `relume render`.
#include "tests/support/read_timings.h"
#include "tests/support/run_relume.h"

using namespace relume::test;

namespace {

constexpr int kFrames = 12;
constexpr const char* kRender =
    "render a.relume -o a.png --size 320x240 --frames 12 --turn light --validation "
    "core,sync ";

void bake(const TemporaryFolder& folder) {
    REQUIRE_EQ(
        runRelume(folder, "bake " + ballIn(folder) +
                              " -K 2 -N 32 --bounces 0 --visibility-size 64 --face-size 32 --map-size 16 -q "
                              "-o a.relume")
            .exitCode,
        0);
}

void checkCpuSpans(const std::vector<ReadSpan>& spans) {
    for (int frame = 0; frame < kFrames; frame++)
        for (const char* name : {"frame", "record", "submit", "wait", "read back", "write image"})
            onlySpan(spans, "CPU", frame, name);
}

// All that is promised of a capture of the frames above.
void checkCapture(const std::vector<ReadSpan>& spans) {
    checkNesting(spans);
    checkCpuSpans(spans);
    for (int frame = 0; frame < kFrames; frame++)
        for (const char* name : {"light sample", "light haar", "light quantize", "relight", "view"})
            onlySpan(spans, "GPU", frame, name);
    checkPassesFillFrames(spans, kFrames);
}

void checkCapture(const nlohmann::json& trace) {
    const std::vector<ReadSpan> spans = readTraceEvents(trace);
    checkCapture(spans);
    checkClocksAgree(spans, kFrames, trace["otherData"]["clock_uncertainty_us"]);
}

} // namespace

TEST_CASE("cli: a timing capture opens as trace events and as a table") {
    const TemporaryFolder folder;
    bake(folder);
    REQUIRE_EQ(runRelume(folder, kRender + std::string("--timings t.json")).exitCode, 0);
    const auto trace = nlohmann::json::parse(contents(folder.path() / "t.json"));
    checkCapture(trace);
    CHECK_FALSE(trace["otherData"]["device"].get<std::string>().empty());

    REQUIRE_EQ(runRelume(folder, kRender + std::string("--timings t.csv")).exitCode, 0);
    checkCapture(readTimingTable(contents(folder.path() / "t.csv")));

    const Outcome lamp = runRelume(folder, "render a.relume -o a.png --size 32x24 --timings u.csv "
                                           "--sphere-light 30,40,5");
    REQUIRE_EQ(lamp.exitCode, 0);
    onlySpan(readTimingTable(contents(folder.path() / "u.csv")), "GPU", 0, "light lamps");
}

TEST_CASE("cli: a device that lacks a way to match clocks, or timestamps, still gives a capture") {
    const TemporaryFolder folder;
    bake(folder);
    const std::string faults = "LD_PRELOAD='" RELUME_FAULTS "' ";
    const Outcome anchored = runRelume(folder, kRender + std::string("--timings t.json"),
                                       faults + "RELUME_FAULT_EXTENSION=VK_EXT_calibrated_timestamps");
    REQUIRE_EQ(anchored.exitCode, 0);
    CHECK(says(anchored.err, "t.json: "));
    CHECK(says(anchored.err, "µs off"));
    auto trace = nlohmann::json::parse(contents(folder.path() / "t.json"));
    CHECK_EQ(trace["otherData"]["clock"], "anchored");
    CHECK_GT(trace["otherData"]["clock_uncertainty_us"].get<double>(), 0);
    checkCapture(trace);

    // A narrow counter: of 64 bits that the device writes, those above the 33rd must not matter.
    REQUIRE_EQ(runRelume(folder, kRender + std::string("--timings t.json"),
                         faults + "RELUME_FAULT_TIMESTAMP_BITS=33")
                   .exitCode,
               0);
    checkCapture(nlohmann::json::parse(contents(folder.path() / "t.json")));

    const Outcome none = runRelume(folder, kRender + std::string("--timings t.json"),
                                   faults + "RELUME_FAULT_TIMESTAMP_BITS=0");
    REQUIRE_EQ(none.exitCode, 0);
    CHECK(says(none.err, "writes no timestamps"));
    trace = nlohmann::json::parse(contents(folder.path() / "t.json"));
    CHECK_EQ(trace["otherData"]["clock"], "none");
    const std::vector<ReadSpan> spans = readTraceEvents(trace);
    checkNesting(spans);
    checkCpuSpans(spans);
    for (const ReadSpan& span : spans) CHECK_EQ(span.track, "CPU");
}

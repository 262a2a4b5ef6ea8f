// What a change of the material costs: by the passes of each frame.
#include "tests/support/read_timings.h"
#include "tests/support/viewer_session.h"

#include <set>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

// Names of the device's passes, frame by frame.
std::vector<std::set<std::string>> passesOf(ViewerSession& session, const std::string& file) {
    std::vector<std::set<std::string>> frames;
    for (const ReadSpan& span : readTraceEvents(json::parse(session.bytes(file)))) {
        if (span.track != "GPU") continue;
        if (frames.size() <= size_t(*span.frame)) frames.resize(size_t(*span.frame) + 1);
        frames[size_t(*span.frame)].insert(span.name);
    }
    return frames;
}

// Every step but "wait" takes one frame: the keys are in the third and fourth frame from the end, the view of
// the last one's is on the screenshot.
json swapTwice(const std::string& screenshot) {
    return {{{"wait", "settled"}},
            {{"frames", 3}},
            {{"screenshot", "before.exr"}},
            {{"key", "M"}}, // the first material, as it was baked
            {{"key", "M"}},
            {{"screenshot", screenshot}},
            {{"quit", true}}};
}

} // namespace

TEST_CASE("viewer: a frame with another material of the set draws the view, and relights nothing") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay(swapTwice("clay.exr"), "ring.relume --timings times.json");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const auto frames = passesOf(session, "times.json");
    const size_t count = frames.size();
    REQUIRE_GE(count, 8u);
    // Two swaps, and the frame after them with all samples.
    for (const size_t swap : {count - 4, count - 3, count - 2}) {
        CHECK(frames[swap].contains("view"));
        CHECK_FALSE(frames[swap].contains("relight"));
        CHECK_FALSE(frames[swap].contains("light quantize"));
    }
    for (const size_t still : {count - 5, count - 1}) {
        CHECK_FALSE(frames[still].contains("view"));
        CHECK(frames[still].contains("display"));
    }
    CHECK(std::ranges::any_of(frames, [](const auto& passes) { return passes.contains("relight"); }));
    CHECK(session.bytes("before.exr") != session.bytes("clay.exr"));
    const Outcome drawn = session.relume(renderCommand(outcome.err, "clay.exr"));
    REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
    CHECK(says(renderCommand(outcome.err, "clay.exr"), "--material 'clay'"));
    CHECK(session.bytes("image.exr") == session.bytes("clay.exr"));
}

TEST_CASE("viewer: a frame with a material of another set relights in the same frame") {
    ViewerSession& session = sharedSession();
    session.bake("separate.relume", "--separate -m gold -m clay");
    const Outcome outcome = session.replay(swapTwice("other.exr"), "separate.relume --timings times.json");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const auto frames = passesOf(session, "times.json");
    REQUIRE_GE(frames.size(), 8u);
    CHECK_FALSE(frames[frames.size() - 4].contains("relight"));
    CHECK(frames[frames.size() - 3].contains("relight"));
    CHECK(frames[frames.size() - 3].contains("view"));
    const Outcome drawn = session.relume(renderCommand(outcome.err, "other.exr"));
    REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
    CHECK(session.bytes("image.exr") == session.bytes("other.exr"));
}

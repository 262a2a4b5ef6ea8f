// A window in which nothing changes.
#include "tests/support/read_timings.h"
#include "tests/support/viewer_session.h"

#include <sys/resource.h>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

// Of all children that have ended, in seconds of one core.
double childTime() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Cost {
    double seconds; // of one core
    int frames;
};

// What a session takes that waits so long in its middle, once all is there.
Cost costOf(ViewerSession& session, double wait) {
    const double before = childTime();
    const Outcome outcome = session.replay({{{"wait", "settled"}}, {{"wait", wait}}, {{"quit", true}}},
                                           "ring.relume --timings idle.json");
    REQUIRE_MESSAGE(outcome.exitCode == 0, outcome.err);
    int frames = 0;
    for (const ReadSpan& span : readTraceEvents(json::parse(session.bytes("idle.json"))))
        frames += span.track == "CPU" && span.name == "frame";
    return {childTime() - before, frames};
}

} // namespace

TEST_CASE("viewer: a window in which nothing changes draws no frame and takes next to no time") {
    ViewerSession& session = sharedSession();
    constexpr double kWait = 4;
    costOf(session, 0.1); // pipelines are kept from here on
    const Cost brief = costOf(session, 0.1), lengthy = costOf(session, kWait);
    // The display may send a late event or two; a window that draws by itself would draw many more.
    REQUIRE_GT(brief.frames, 0);
    CHECK_LE(lengthy.frames, brief.frames + 8);
    // A loop that does not sleep would take all of a core. What starts and ends a session takes the same
    // in both, up to what a busy machine adds.
    const double share = (lengthy.seconds - brief.seconds) / (kWait - 0.1);
    MESSAGE("an idle window takes " << 100 * share << " % of a core");
    CHECK_LT(share, 0.5);
}

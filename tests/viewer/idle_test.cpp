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

// What a session takes that waits so long in its middle, once all is there.
double timeOf(Session& session, double wait) {
    const double before = childTime();
    const Outcome outcome = session.replay({{{"wait", "settled"}}, {{"wait", wait}}, {{"quit", true}}},
                                           "ring.relume --timings idle.json");
    REQUIRE_MESSAGE(outcome.exitCode == 0, outcome.err);
    return childTime() - before;
}

} // namespace

TEST_CASE("viewer: a window in which nothing changes draws no frame and takes next to no time") {
    Session& session = sharedSession();
    constexpr double kWait = 4;
    timeOf(session, 0.1); // pipelines are kept from here on
    const double brief = timeOf(session, 0.1);
    const double lengthy = timeOf(session, kWait);
    const double share = (lengthy - brief) / (kWait - 0.1);
    MESSAGE("an idle window takes " << 100 * share << " % of a core");
    CHECK_LT(share, 0.1);

    // The longest span without a frame is the wait.
    double last = 0, longest = 0;
    for (const ReadSpan& span : readTraceEvents(json::parse(session.bytes("idle.json")))) {
        if (span.track != "CPU" || span.name != "frame") continue;
        longest = std::max(longest, span.start - last);
        last = span.end();
    }
    CHECK_GT(longest, 0.95 * 1e6 * kWait);
}

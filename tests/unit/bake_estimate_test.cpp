// Tests the remaining time of a bake whose parts differ in cost.
#include "precompute/bake/bake_estimate.h"

#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("bake estimate: within a fifth after the first tenth, where the probe was off by half") {
    // An object of 30,000 vertices at 5 ms, then a ground of 10,000 at 1 ms: the probes said 7.5 ms and 1.5
    // ms.
    BakeEstimate estimate({{30000, 0, 7.5e-3}, {10000, 0, 1.5e-3}});
    CHECK_EQ(estimate.status().secondsLeft, 0); // unknown
    const double whole = 30000 * 5e-3 + 10000 * 1e-3;
    double elapsed = 0;
    for (int part = 0; part < 2; part++)
        for (int done = 0; done < (part == 0 ? 30000 : 10000); done += 50) {
            const double seconds = 50 * (part == 0 ? 5e-3 : 1e-3);
            estimate.add(size_t(part), 50, seconds);
            elapsed += seconds;
            const BakeStatus status = estimate.status();
            if (elapsed < 0.1 * whole) continue;
            CHECK(status.secondsLeft == doctest::Approx(whole - elapsed).epsilon(0.05));
            CHECK(status.fraction == doctest::Approx(elapsed / whole).epsilon(0.05));
        }
    CHECK_EQ(estimate.status().done, 40000u);
    CHECK_EQ(estimate.status().fraction, 1);
}

TEST_CASE("bake estimate: a resumed bake counts its own work for the rate, all for the fraction") {
    BakeEstimate estimate({{1000, 600, 1}});
    estimate.add(0, 300, 3);
    const BakeStatus status = estimate.status();
    CHECK_EQ(status.done, 900u);
    CHECK(status.fraction == doctest::Approx(0.9));
    CHECK(status.verticesPerSecond == doctest::Approx(100));
    CHECK(status.secondsLeft == doctest::Approx(1));
}

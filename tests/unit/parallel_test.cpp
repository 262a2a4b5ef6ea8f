#include "engine/base/parallel.h"

#include <atomic>
#include <doctest/doctest.h>
#include <stdexcept>
#include <vector>

using namespace relume;

TEST_CASE("parallel loop: every index once") {
    for (size_t count : {0, 1, 2, 1000}) {
        std::vector<std::atomic<int>> calls(count);
        parallelFor(count, [&](size_t i) { calls[i]++; });
        for (const std::atomic<int>& ofOne : calls) CHECK(ofOne == 1);
    }
}

TEST_CASE("parallel loop: what a call throws is rethrown, and ends the loop") {
    std::atomic<size_t> calls = 0;
    CHECK_THROWS_AS(parallelFor(1'000'000'000'000,
                                [&](size_t) {
                                    calls++;
                                    throw std::runtime_error("no");
                                }),
                    std::runtime_error);
    CHECK(calls < 1000); // one a thread
}

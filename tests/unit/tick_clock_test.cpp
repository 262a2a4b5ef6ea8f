#include "engine/vk/tick_clock.h"

#include <doctest/doctest.h>
#include <random>

using relume::vk::ticksBetween, relume::vk::TickClock;

namespace {

// A counter of `bits` bits that ticks every `nanoseconds` and showed `start` at time 0; the bits above are
// noise.
struct Counter {
    double nanoseconds;
    uint32_t bits;
    uint64_t start;
    std::mt19937_64 noise{5};

    uint64_t at(int64_t time) {
        const uint64_t ticks = start + uint64_t(std::llround(double(time) / nanoseconds));
        return bits == 64 ? ticks : (ticks & ((uint64_t(1) << bits) - 1)) | noise() << bits;
    }
};

} // namespace

TEST_CASE("tick clock: ticks between readings ignore bits that do not count, and wrap around") {
    CHECK_EQ(ticksBetween(10, 25, 64), 15u);
    CHECK_EQ(ticksBetween(~uint64_t(0) - 4, 5, 64), 10u);
    CHECK_EQ(ticksBetween(0xf0000000fffffff0, 0xa000000000000010, 32), 0x20u);
    CHECK_EQ(ticksBetween(0xfff, 0x100, 8), 1u);
    CHECK_EQ(ticksBetween(0x1ffffffff, 0x2ffffffff, 32), 0u);
    CHECK_EQ(ticksBetween(1, 0, 1), 1u);
}

TEST_CASE("tick clock: readings become times, however often the counter wraps in between") {
    for (Counter counter :
         {Counter{1, 64, 0}, Counter{1, 64, ~uint64_t(0) - 1000}, Counter{1, 36, 0xfffffff00},
          Counter{83.333, 36, 7}, Counter{52.08, 32, 0xffffffff}, Counter{1, 32, 0x80000000}}) {
        CAPTURE(counter.bits);
        CAPTURE(counter.start);
        const int64_t origin = 123'456'789'012; // the CPU's clock at time 0
        const double turn = counter.nanoseconds * std::pow(2.0, double(counter.bits));
        TickClock clock(counter.nanoseconds, counter.bits);
        clock.calibrate(counter.at(0), origin);
        // A frame a minute for an hour: a counter of 32 bits at 1 ns turns fourteen times in between.
        for (int64_t minute = 0; minute < 60; minute++) {
            const int64_t time = minute * 60'000'000'000;
            const auto off = int64_t(std::min(0.45 * turn, 3e10));
            for (const int64_t near : {time, time - off, time + off}) {
                const int64_t ticks = clock.sinceFirst(counter.at(time), origin + near);
                CHECK_LE(std::abs(clock.nanoseconds(ticks) - origin - time),
                         int64_t(counter.nanoseconds) + 1);
            }
        }
    }
}

TEST_CASE("tick clock: a reading before the first calibration has a time before it") {
    Counter counter{1, 36, 500};
    TickClock clock(1, 36);
    clock.calibrate(counter.at(1000), 1000);
    CHECK_EQ(clock.sinceFirst(counter.at(100), 1000), -900);
    CHECK_EQ(clock.nanoseconds(-900), 100);
}

TEST_CASE("tick clock: drift is followed, and time never runs backwards") {
    // The device's clock gains 200 ppm at first and loses 300 ppm later; told to tick every 10 ns.
    const auto ticksAt = [](int64_t time) {
        const double early = std::min(double(time), 5e9), late = double(time) - early;
        return uint64_t(std::llround((early * 1.0002 + late * 0.9997) / 10));
    };
    TickClock clock(10, 40);
    for (int64_t time = 0; time <= 10'000'000'000; time += 1'000'000'000)
        clock.calibrate(ticksAt(time), time);
    int64_t last = -1;
    for (int64_t time = 0; time < 11'000'000'000; time += 1'234'567) {
        const int64_t found = clock.nanoseconds(clock.sinceFirst(ticksAt(time), time + 50'000'000));
        const int64_t allowed = time <= 10'000'000'000 ? 20 : 20 + (time - 10'000'000'000) * 3 / 10'000;
        CHECK_LE(std::abs(found - time), allowed);
        CHECK_LE(last, found);
        last = found;
    }
}

TEST_CASE("tick clock: calibrations within one tick of each other are taken as one") {
    TickClock clock(1000, 64);
    clock.calibrate(5, 10'000);
    clock.calibrate(5, 10'400);
    clock.calibrate(7, 12'000);
    CHECK_EQ(clock.nanoseconds(clock.sinceFirst(6, 11'000)), 11'000);
    CHECK_EQ(clock.nanoseconds(clock.sinceFirst(9, 14'000)), 14'000);
}

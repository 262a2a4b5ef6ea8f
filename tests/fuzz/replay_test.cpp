// Every fuzz target on its seeds and on some mutations of each: in any build, with any compiler.
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <random>

using namespace relume::test;

namespace {

// One to four changes: a bit, a byte, a number that is at a limit, a run removed, repeated or cut off.
Bytes mutated(Bytes bytes, std::mt19937& random) {
    constexpr std::array<uint32_t, 6> kLimits = {0, 1, 0x7f, 0xff, 0x7fffffff, 0xffffffff};
    for (uint32_t change = 0; change <= random() % 4 && !bytes.empty(); change++) {
        const size_t place = random() % bytes.size();
        const size_t length = std::min<size_t>(1 + random() % 16, bytes.size() - place);
        const auto at = bytes.begin() + ptrdiff_t(place);
        switch (random() % 6) {
        case 0:
            *at ^= std::byte(1 << random() % 8);
            break;
        case 1:
            *at = std::byte(random());
            break;
        case 2:
            for (size_t i = 0; i < std::min<size_t>(length, 4); i++)
                at[ptrdiff_t(i)] = std::byte(kLimits[random() % kLimits.size()] >> 8 * i);
            break;
        case 3:
            bytes.erase(at, at + ptrdiff_t(length));
            break;
        case 4: {
            const Bytes run(at, at + ptrdiff_t(length));
            bytes.insert(at, run.begin(), run.end());
            break;
        }
        case 5:
            if (random() % 4 == 0) bytes.resize(place);
            break;
        }
    }
    return bytes;
}

} // namespace

TEST_CASE("fuzz targets: seeds and mutations of them are read or refused") {
    REQUIRE_FALSE(fuzzTargets().empty());
    for (const FuzzTarget& target : fuzzTargets()) {
        CAPTURE(target.name);
        const std::vector<Bytes> seeds = target.seeds();
        REQUIRE_FALSE(seeds.empty());
        std::mt19937 random(1);
        for (size_t number = 0; number < seeds.size(); number++) {
            CAPTURE(number);
            CHECK_NOTHROW(target.run(seeds[number]));
            for (int mutation = 0; mutation < target.mutations; mutation++) {
                CAPTURE(mutation);
                CHECK_NOTHROW(target.run(mutated(seeds[number], random)));
            }
        }
    }
}

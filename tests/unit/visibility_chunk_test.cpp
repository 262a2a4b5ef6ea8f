// Tests the visibility chunk: it round-trips, is small, and anything malformed is refused.
#include "engine/chunk/chunk_file.h"
#include "engine/transport/visibility_chunk.h"

#include "engine/base/error.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <functional>
#include <random>

using namespace relume;

namespace {

// Bits above a slanted horizon, with some noise.
std::vector<uint32_t> sampleBits(size_t vertices, uint32_t size) {
    std::mt19937 random(1);
    std::vector<uint32_t> bits(vertices * 6 * size * size / 32);
    for (size_t row = 0; row < vertices * 6 * size; row++)
        for (uint32_t x = 0; x < size; x++) {
            const bool isAbove = row % (6 * size) / 3 + row / (6 * size) > x;
            if (isAbove != (random() % 500 == 0)) bits[(row * size + x) / 32] |= 1u << x % 32;
        }
    return bits;
}

} // namespace

TEST_CASE("visibility chunk: bits come back, whatever they are") {
    std::mt19937 random(1);
    for (const uint32_t size : {64u, 128u, 256u})
        for (const size_t vertices : {1, 3, 64}) {
            CAPTURE(size);
            CAPTURE(vertices);
            std::vector<uint32_t> bits = sampleBits(vertices, size);
            for (const auto& fill : {std::function<uint32_t(uint32_t)>([](uint32_t word) { return word; }),
                                     std::function<uint32_t(uint32_t)>([](uint32_t) { return ~0u; }),
                                     std::function<uint32_t(uint32_t)>([](uint32_t) { return 0u; }),
                                     std::function<uint32_t(uint32_t)>([&](uint32_t) { return random(); })}) {
                std::ranges::transform(bits, bits.begin(), fill);
                const auto coded = encodeVisibility(bits, size);
                CHECK_GE(coded.size(), smallestVisibilityChunk(vertices, size));
                CHECK_LE(coded.size(), largestVisibilityChunk(vertices, size));
                CHECK(decodeVisibility(coded, vertices, size, "sample") == bits);
            }
        }
}

TEST_CASE("visibility chunk: what is all free is stored small, within the ratio that readers allow") {
    const std::vector<uint32_t> free(64 * 6 * 256 * 256 / 32, ~0u);
    const StoredChunk stored = storeChunk(chunkTag("visb"), 0, 0, encodeVisibility(free, 256));
    CHECK_LT(stored.bytes.size(), 64 * 32);
    CHECK_LT(largestVisibilityChunk(64, 256), kLargestChunk);
}

TEST_CASE("visibility chunk: what is cut, longer or damaged is refused or gives bits of the right size") {
    const size_t vertices = 4;
    const auto coded = encodeVisibility(sampleBits(vertices, 64), 64);
    const size_t words = vertices * 6 * 64 * 64 / 32;
    for (size_t length = 0; length < coded.size(); length += 1 + length / 7)
        CHECK_THROWS_AS(decodeVisibility(std::span(coded).first(length), vertices, 64, "cut"), Error);
    auto longer = coded;
    longer.push_back(std::byte(1));
    CHECK_THROWS_AS(decodeVisibility(longer, vertices, 64, "longer"), Error);
    CHECK_THROWS_AS(decodeVisibility(coded, vertices + 1, 64, "other"), Error);
    CHECK_THROWS_AS(decodeVisibility(coded, vertices, 128, "other"), Error);
    std::mt19937 random(2);
    int refused = 0;
    for (int i = 0; i < 500; i++) {
        auto damaged = coded;
        damaged[random() % (i % 2 ? damaged.size() : 48)] ^= std::byte(1 << random() % 8);
        try {
            const std::vector<uint32_t> bits = decodeVisibility(damaged, vertices, 64, "damaged");
            CHECK_EQ(bits.size(), words);
        } catch (const Error&) {
            refused++;
        }
    }
    CHECK_GT(refused, 200); // flags that are wrong ask for more or fewer bytes
}

#include "precompute/bake/storing_sink.h"

#include "tests/support/shard_sample.h"

#include <doctest/doctest.h>
#include <limits>
#include <set>
#include <tbb/global_control.h>

using namespace relume;
using namespace relume::test;

TEST_CASE(
    "storing sink: keeps blocks as they are stored, in their order, on any threads and in little memory") {
    const Asset asset = shardedAsset();
    const BakePlan plan = planIn(asset, TransportLayout::Bases);
    for (const size_t threads : {1, 4})
        for (const uint64_t bytes : {uint64_t(0), uint64_t(1) << 20}) {
            CAPTURE(threads);
            CAPTURE(bytes);
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            std::vector<uint32_t> kept;
            StoringSink sink(plan, bytes, [&](uint32_t block, const StoredBlock& stored) {
                CHECK_EQ(stored.chunks.size(), chunksOf(plan, block));
                kept.push_back(block);
            });
            for (uint32_t block = 0; block < plan.blocks.size(); block++) {
                sink.take(block, bakedBlock(plan, asset, block));
                if (threads == 1) CHECK_EQ(kept.size(), block + 1);
                if (bytes == 0) CHECK_GE(kept.size(), block); // never two in hand
            }
            sink.finish();
            REQUIRE_EQ(kept.size(), plan.blocks.size());
            CHECK(std::ranges::is_sorted(kept));
        }
}

TEST_CASE("storing sink: a block that cannot be stored takes no other along") {
    const Asset asset = shardedAsset();
    const BakePlan plan = planIn(asset, TransportLayout::Rows);
    for (const size_t threads : {1, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        std::set<uint32_t> kept;
        StoringSink sink(plan, 1 << 20, [&](uint32_t block, const StoredBlock&) { kept.insert(block); });
        int failures = 0;
        const auto attempt = [&](const auto& work) {
            try {
                work();
            } catch (const Error&) {
                failures++;
            }
        };
        for (uint32_t block = 0; block < 4; block++) {
            BakedBlock baked = bakedBlock(plan, asset, block);
            if (block == 1) baked.sets[0].transport.scales[0] = std::numeric_limits<float>::infinity();
            attempt([&] { sink.take(block, std::move(baked)); });
        }
        attempt([&] { sink.finish(); });
        CHECK_EQ(failures, 1);
        CHECK_GE(kept.size(), 2); // but those in whose place the error came
        CHECK_FALSE(kept.contains(1));
        CHECK(kept.contains(0));
    }
}

TEST_CASE("storing sink: what waits is a quarter of what a bake may take") {
    CHECK_EQ(StoringSink::bytesInHand({}), uint64_t(256) << 20);
    CHECK_EQ(StoringSink::bytesInHand({.memory = 64 << 20}), uint64_t(16) << 20);
    CHECK_EQ(StoringSink::bytesInHand({.memory = uint64_t(8) << 30}), uint64_t(256) << 20);
}

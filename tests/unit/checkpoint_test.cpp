#include "precompute/bake/checkpoint.h"

#include "tests/support/checkpoint_sample.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

TEST_CASE("checkpoint: what it holds is found again, in every layout") {
    const Asset asset = shardedAsset();
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        const TemporaryFolder folder;
        const BakePlan plan = planIn(asset, layout);
        const SampleBlocks blocks(plan, asset);
        {
            Checkpoint checkpoint(folder.path() / "c");
            checkpoint.resume(plan);
            if (plan.scale) checkpoint.append(*plan.scale);
            for (const uint32_t block : {2u, 0u}) checkpoint.append(block, blockOf(blocks, block));
        }
        Checkpoint checkpoint(folder.path() / "c");
        checkpoint.resume(plan);
        CHECK(checkpoint.scale() == plan.scale);
        CHECK(checkpoint.has(0));
        CHECK_FALSE(checkpoint.has(1));
        CHECK(checkpoint.has(2));
        for (const ChunkEntry& entry : checkpoint.chunks(2))
            CHECK(checkpoint.load(2, entry) == blocks.load(2, entry));
    }
}

TEST_CASE("checkpoint: blocks without the scale that they need are dropped, and a scale that none needs") {
    const Asset asset = shardedAsset();
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        const TemporaryFolder folder;
        const BakePlan plan = planIn(asset, layout);
        const SampleBlocks blocks(plan, asset);
        const LayoutScale scale{std::vector<float>(3, 1.0f), 1e-4};
        {
            Checkpoint checkpoint(folder.path() / "c");
            checkpoint.resume(plan);
            if (layout == TransportLayout::Rows) checkpoint.append(scale);
            checkpoint.append(1, blockOf(blocks, 1));
            if (layout != TransportLayout::Rows) checkpoint.append(scale);
        }
        Checkpoint checkpoint(folder.path() / "c");
        checkpoint.resume(plan);
        CHECK_FALSE(checkpoint.scale());
        CHECK_FALSE(checkpoint.has(1));
        if (plan.scale) checkpoint.append(*plan.scale);
        checkpoint.append(1, blockOf(blocks, 1));
        CHECK(checkpoint.has(1));
    }
}

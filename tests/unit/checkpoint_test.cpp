#include "precompute/bake/checkpoint.h"

#include "engine/base/file.h"
#include "tests/support/checkpoint_sample.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

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

TEST_CASE("checkpoint: what follows a second scale, or one of no use, is dropped") {
    const Asset asset = shardedAsset();
    const BakePlan plan = planIn(asset, TransportLayout::Bases);
    const SampleBlocks blocks(plan, asset);
    const LayoutScale good = *plan.scale;
    std::vector<LayoutScale> useless(5, good);
    useless[0].norms[0] = 0;
    useless[1].norms[1] = -1;
    useless[2].norms[2] = std::numeric_limits<float>::infinity();
    useless[3].lambda = -1e-4;
    useless[4].lambda = std::nan("");
    // Returns whether a block is found after so many copies of a scale.
    const auto hasBlockAfter = [&](const LayoutScale& scale, int copies) {
        const TemporaryFolder folder;
        const std::filesystem::path path = folder.path() / "c";
        size_t start = 0, end = 0; // of the scale
        {
            Checkpoint checkpoint(path);
            checkpoint.resume(plan);
            start = std::filesystem::file_size(path);
            checkpoint.append(scale);
            end = std::filesystem::file_size(path);
            checkpoint.append(1, blockOf(blocks, 1));
        }
        const std::vector<std::byte> bytes = readFile(path);
        const std::string file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        std::string scales;
        for (int i = 0; i < copies; i++) scales += file.substr(start, end - start);
        folder.write("c", file.substr(0, start) + scales + file.substr(end));
        Checkpoint checkpoint(path);
        checkpoint.resume(plan);
        return checkpoint.has(1);
    };
    CHECK(hasBlockAfter(good, 1));
    CHECK_FALSE(hasBlockAfter(good, 0));
    CHECK_FALSE(hasBlockAfter(good, 2));
    for (const LayoutScale& scale : useless) CHECK_FALSE(hasBlockAfter(scale, 1));
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

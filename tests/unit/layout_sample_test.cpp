#include "precompute/bake/layout_sample.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

// Parts of so many vertices each, of one set, cut into blocks of 256.
BakePlan planOfParts(const std::vector<uint32_t>& vertices, int terms, int coefficients) {
    BakePlan plan;
    plan.asset.coefficients = coefficients;
    plan.blockVertices = 256;
    for (uint32_t part = 0; part < vertices.size(); part++) {
        plan.asset.parts.emplace_back();
        plan.asset.parts.back().mesh.positions.resize(vertices[part]);
        plan.asset.parts.back().sets.emplace_back().brdf.terms = terms;
        for (uint32_t first = 0; first < vertices[part]; first += 256)
            plan.blocks.push_back({part, first, std::min(first + 256, vertices[part])});
    }
    return plan;
}

struct Sampled {
    uint64_t vertices = 0;
    std::vector<uint32_t> ofPart; // blocks
};

Sampled sampledOf(const BakePlan& plan) {
    Sampled sampled{0, std::vector<uint32_t>(plan.asset.parts.size(), 0)};
    const std::vector<uint32_t> blocks = sampleBlocks(plan);
    for (size_t i = 0; i < blocks.size(); i++) {
        CHECK((i == 0 || blocks[i - 1] < blocks[i]));
        sampled.vertices += plan.blocks[blocks[i]].count();
        sampled.ofPart[plan.blocks[blocks[i]].part]++;
    }
    return sampled;
}

} // namespace

TEST_CASE("layout sample: a quarter, at most 8192 vertices, at least four blocks of each of few parts") {
    CHECK(sampledOf(planOfParts({256 * 16}, 4, 384)).ofPart == std::vector{4u});
    CHECK(sampledOf(planOfParts({256 * 100}, 4, 384)).ofPart == std::vector{25u});
    CHECK(sampledOf(planOfParts({256 * 4000}, 4, 384)).ofPart == std::vector{32u});
    CHECK(sampledOf(planOfParts({256 * 3000, 256 * 1000, 256 * 10, 300, 1}, 4, 384)).ofPart ==
          std::vector{24u, 8u, 4u, 2u, 1u});
    // Blocks lie in the middles of as many stretches.
    CHECK(sampleBlocks(planOfParts({256 * 16}, 4, 384)) == std::vector{2u, 6u, 10u, 14u});
}

TEST_CASE("layout sample: does not grow with the number of parts") {
    const Sampled hundreds = sampledOf(planOfParts(std::vector<uint32_t>(100, 1000), 1, 384));
    CHECK(hundreds.ofPart == std::vector<uint32_t>(100, 1));
    const Sampled thousands = sampledOf(planOfParts(std::vector<uint32_t>(3000, 700), 1, 384));
    CHECK_LE(thousands.vertices, 32768u);
    CHECK_GT(thousands.vertices, 32768u - 256);
    // Those of which something is sampled are spread over all.
    uint32_t gap = 0, longest = 0;
    for (const uint32_t blocks : thousands.ofPart) longest = std::max(longest, gap = blocks ? 0 : gap + 1);
    CHECK_LE(longest, 3000 / 128);
}

TEST_CASE("layout sample: its rows fit memory, but for a single block") {
    constexpr uint64_t kBytes = uint64_t(256) << 20;
    for (const uint32_t parts : {1u, 7u, 100u}) {
        const uint64_t vertexBytes = 32 * 1500 * 6;
        const Sampled sampled = sampledOf(planOfParts(std::vector<uint32_t>(parts, 20000), 32, 1500));
        CHECK_LE(sampled.vertices * vertexBytes, kBytes);
        CHECK_GT(sampled.vertices * vertexBytes, kBytes / 4 * 3);
    }
    const Sampled single = sampledOf(planOfParts(std::vector<uint32_t>(50, 256), 32, 24576));
    CHECK_EQ(single.vertices, 256u);
}

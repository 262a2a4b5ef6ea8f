#include "precompute/bake/vertex_rows.h"

#include <algorithm>
#include <numeric>

namespace relume {

namespace {

// A plan of these vertices alone, without an occluder yet.
BakePlan planOfVertices(const BakePlan& plan, std::span<const std::vector<uint32_t>> chosen) {
    BakePlan result{plan.options};
    result.asset.faceSize = plan.asset.faceSize;
    result.asset.coefficients = plan.asset.coefficients;
    result.asset.visibilityOffset = plan.asset.visibilityOffset;
    result.blockVertices = plan.blockVertices;
    result.options.keepVisibility = false;
    result.firstSet = plan.firstSet;
    for (uint32_t number = 0; number < chosen.size(); number++) {
        const AssetPart& part = plan.asset.parts[number];
        AssetPart& fewer = result.asset.parts.emplace_back();
        fewer.name = part.name;
        fewer.sets = part.sets;
        for (const uint32_t vertex : chosen[number]) {
            fewer.mesh.positions.push_back(part.mesh.positions[vertex]);
            fewer.mesh.normals.push_back(part.mesh.normals[vertex]);
        }
        const auto vertices = uint32_t(fewer.mesh.vertexCount());
        for (uint32_t first = 0; first < vertices; first += plan.blockVertices)
            result.blocks.push_back({number, first, std::min(first + plan.blockVertices, vertices)});
    }
    return result;
}

// Rows of all vertices of a plan, a BakedRows per set over all parts: takes the blocks in order.
class RowsSink : public BakeSink {
  public:
    explicit RowsSink(const BakePlan& plan) : mPlan(plan) {
        for (const AssetPart& part : plan.asset.parts)
            for (const MaterialSet& set : part.sets) rows.emplace_back(uint32_t(set.brdf.terms));
    }

    void take(uint32_t block, BakedBlock baked) override {
        const uint32_t firstSet = mPlan.firstSet[mPlan.blocks[block].part];
        for (size_t set = 0; set < baked.sets.size(); set++) rows[firstSet + set].append(baked.sets[set]);
    }

    std::vector<BakedRows> rows;

  private:
    const BakePlan& mPlan;
};

} // namespace

std::vector<BakedRows> bakeVertices(const vk::Device& device, BakePlan& plan,
                                    std::span<const std::vector<uint32_t>> vertices, const BakeLimits& limits,
                                    BakeObserver& observer) {
    BakePlan fewer = planOfVertices(plan, vertices);
    std::swap(fewer.asset.occluder, plan.asset.occluder); // large: never twice
    std::vector<uint32_t> blocks(fewer.blocks.size());
    std::iota(blocks.begin(), blocks.end(), 0u);
    RowsSink sink(fewer);
    BakeTimes times;
    bakeBlocks(device, fewer, blocks, blocks, limits, sink, observer, times);
    std::swap(fewer.asset.occluder, plan.asset.occluder);
    return std::move(sink.rows);
}

} // namespace relume

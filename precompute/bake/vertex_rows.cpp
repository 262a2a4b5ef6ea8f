#include "precompute/bake/vertex_rows.h"

#include <algorithm>

namespace relume {

namespace {

// Returns a plan of these vertices alone, without an occluder yet.
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
            if (!part.mesh.tangents.empty()) fewer.mesh.tangents.push_back(part.mesh.tangents[vertex]);
        }
        const auto vertices = uint32_t(fewer.mesh.vertexCount());
        for (uint32_t first = 0; first < vertices; first += plan.blockVertices)
            result.blocks.push_back({number, first, std::min(first + plan.blockVertices, vertices)});
    }
    return result;
}

class RowsSink : public BakeSink {
  public:
    RowsSink(const BakePlan& plan, const TakeRows& take) : mPlan(plan), mTake(take) {}

    void take(uint32_t block, BakedBlock baked) override { mTake(mPlan.blocks[block].part, baked.sets); }

  private:
    const BakePlan& mPlan;
    const TakeRows& mTake;
};

} // namespace

uint64_t rowBytes(int rows, uint64_t entries) {
    constexpr uint64_t kEntryBytes = sizeof(uint16_t) + sizeof(uint32_t);
    constexpr uint64_t kRowBytes = sizeof(float) + sizeof(uint64_t) + sizeof(TransportLosses);
    return uint64_t(rows) * kRowBytes + entries * kEntryBytes;
}

void bakeVertices(const vk::Device& device, BakePlan& plan, std::span<const std::vector<uint32_t>> vertices,
                  const BakeLimits& limits, const TakeRows& take, BakeObserver& observer, BakeTimes& times) {
    BakePlan fewer = planOfVertices(plan, vertices);
    std::swap(fewer.asset.occluder, plan.asset.occluder); // large: never two copies
    const std::vector<uint32_t> blocks = fewer.allBlocks();
    RowsSink sink(fewer, take);
    bakeBlocks(device, fewer, blocks, blocks, limits, sink, observer, times);
    std::swap(fewer.asset.occluder, plan.asset.occluder);
}

} // namespace relume

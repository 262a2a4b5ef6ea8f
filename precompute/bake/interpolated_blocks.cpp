#include "precompute/bake/interpolated_blocks.h"

#include "precompute/bake/coarse_neighbours.h"
#include "precompute/bake/coarse_vertices.h"
#include "precompute/bake/row_interpolation.h"
#include "precompute/bake/vertex_rows.h"

#include <algorithm>
#include <optional>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr uint64_t kVerticesPerCoarse = 12;
constexpr uint64_t kCoarseRowBytes = uint64_t(256) << 20;
constexpr int kMostInterpolated = 96;        // coefficients of a row: more do not show
constexpr uint32_t kVerticesTogether = 2048; // interpolated between two looks at whether to stop

// The coarse vertices of a part; none of one that needs no blocks.
struct CoarsePart {
    std::vector<uint32_t> vertices;
    float spacing = 1;
};

std::vector<CoarsePart> chooseVertices(const BakePlan& plan, std::span<const uint32_t> blocks) {
    std::vector<CoarsePart> coarse(plan.asset.parts.size());
    std::vector<bool> isNeeded(coarse.size(), false);
    for (const uint32_t block : blocks) isNeeded[plan.blocks[block].part] = true;
    uint64_t allBytes = 0;
    for (const AssetPart& part : plan.asset.parts)
        allBytes += part.mesh.vertexCount() * rowBytes(plan.asset, part);
    const uint64_t each = std::max(kVerticesPerCoarse, (allBytes + kCoarseRowBytes - 1) / kCoarseRowBytes);
    for (size_t number = 0; number < coarse.size(); number++) {
        if (!isNeeded[number]) continue;
        const Mesh& mesh = plan.asset.parts[number].mesh;
        const size_t count = (mesh.vertexCount() + each - 1) / each;
        coarse[number].spacing = vertexSpacing(mesh, count);
        coarse[number].vertices = coarseVertices(mesh, count, coarse[number].spacing);
    }
    return coarse;
}

} // namespace

void interpolateBlocks(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> blocks,
                       const BakeLimits& limits, Checkpoint& interpolated, BakeObserver& observer) {
    std::vector<uint32_t> lacking;
    std::ranges::copy_if(blocks, std::back_inserter(lacking),
                         [&](uint32_t block) { return !interpolated.has(block); });
    if (lacking.empty()) return;
    const std::vector<CoarsePart> coarse = chooseVertices(plan, lacking);
    std::vector<std::vector<uint32_t>> chosen;
    for (const CoarsePart& part : coarse) chosen.push_back(part.vertices);
    StageObserver coarseObserver(observer, BakeStage::Preview);
    std::vector<BakedRows> rows; // per set, over all parts
    for (const AssetPart& part : plan.asset.parts)
        for (const MaterialSet& set : part.sets) rows.emplace_back(uint32_t(set.brdf.terms));
    const auto take = [&](uint32_t part, std::span<const BakedRows> sets) {
        for (size_t set = 0; set < sets.size(); set++) rows[plan.firstSet[part] + set].append(sets[set]);
    };
    BakeTimes times; // which previews have apart
    bakeVertices(device, plan, chosen, limits, take, coarseObserver, times);

    std::vector<std::optional<CoarseNeighbours>> neighbours(coarse.size());
    for (size_t part = 0; part < coarse.size(); part++)
        if (!coarse[part].vertices.empty())
            neighbours[part].emplace(plan.asset.parts[part].mesh, coarse[part].vertices,
                                     coarse[part].spacing);
    const auto interpolate = [&](uint32_t block) {
        const BakeBlock& place = plan.blocks[block];
        std::vector<std::vector<CoarseNeighbour>> of;
        for (uint32_t vertex = place.first; vertex < place.end; vertex++)
            of.push_back(neighbours[place.part]->of(vertex));
        BakedBlock made;
        for (size_t set = 0; set < plan.asset.parts[place.part].sets.size(); set++) {
            const BakedRows& from = rows[plan.firstSet[place.part] + set];
            RowInterpolator interpolator(from, 6 * plan.asset.faceSize * plan.asset.faceSize,
                                         std::min(plan.asset.coefficients, kMostInterpolated));
            BakedRows& to = made.sets.emplace_back(from.transport.terms);
            for (const auto& own : of) interpolator.append(own, to);
        }
        return storeBlock(plan, block, std::move(made));
    };
    for (std::span<const uint32_t> left(lacking); !left.empty();) {
        if (observer.wantsStop()) throw BakeStopped("stopped");
        const size_t together = std::max(1u, kVerticesTogether / plan.blockVertices);
        const auto some = left.first(std::min(together, left.size()));
        std::vector<StoredBlock> stored(some.size());
        tbb::parallel_for(size_t(0), some.size(), [&](size_t i) { stored[i] = interpolate(some[i]); });
        for (size_t i = 0; i < some.size(); i++) interpolated.append(some[i], stored[i]);
        left = left.subspan(some.size());
    }
}

} // namespace relume

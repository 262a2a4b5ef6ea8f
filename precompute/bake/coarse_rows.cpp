#include "precompute/bake/coarse_rows.h"

#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/coarse_neighbors.h"
#include "precompute/bake/coarse_vertices.h"
#include "precompute/bake/vertex_rows.h"

#include <algorithm>
#include <optional>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr uint64_t kVerticesPerCoarse = 12;
constexpr uint64_t kCoarseRowBytes = uint64_t(256) << 20;
constexpr int kMostInterpolated = 96;        // row entries; more make no visible difference
constexpr uint32_t kVerticesTogether = 2048; // interpolated between polls for a stop

} // namespace

CoarseRows::CoarseRows(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> blocks,
                       const BakeLimits& limits, BakeObserver& observer)
    : mParts(plan.asset.parts.size()) {
    std::vector<bool> isNeeded(mParts.size(), false);
    for (const uint32_t block : blocks) isNeeded[plan.blocks[block].part] = true;
    uint64_t allBytes = 0;
    for (const AssetPart& part : plan.asset.parts)
        allBytes += part.mesh.vertexCount() * rowBytes(termCount(part), rowEntries(plan.asset, part));
    const uint64_t each = std::max(kVerticesPerCoarse, (allBytes + kCoarseRowBytes - 1) / kCoarseRowBytes);
    std::vector<std::vector<uint32_t>> chosen(mParts.size());
    for (size_t number = 0; number < mParts.size(); number++) {
        if (!isNeeded[number]) continue;
        const Mesh& mesh = plan.asset.parts[number].mesh;
        const size_t count = (mesh.vertexCount() + each - 1) / each;
        mParts[number].spacing = vertexSpacing(mesh, count);
        mParts[number].vertices = coarseVertices(mesh, count, mParts[number].spacing);
        chosen[number] = mParts[number].vertices;
    }
    for (const AssetPart& part : plan.asset.parts)
        for (const MaterialSet& set : part.sets) mRows.emplace_back(uint32_t(set.brdf.terms));
    const auto take = [&](uint32_t part, std::span<const BakedRows> sets) {
        for (size_t set = 0; set < sets.size(); set++) mRows[plan.firstSet[part] + set].append(sets[set]);
    };
    StageObserver coarseObserver(observer, BakeStage::Preview);
    BakeTimes times; // not reported: previews have a time of their own
    bakeVertices(device, plan, chosen, limits, take, coarseObserver, times);
}

void CoarseRows::interpolate(const BakePlan& plan, std::span<const uint32_t> blocks,
                             const std::function<void(uint32_t block, StoredBlock stored)>& store,
                             BakeObserver& observer) const {
    const int faceSize = plan.asset.faceSize, kept = std::min(plan.asset.coefficients, kMostInterpolated);
    std::vector<std::optional<CoarseNeighbors>> neighbors(mParts.size());
    for (size_t part = 0; part < mParts.size(); part++)
        if (!mParts[part].vertices.empty())
            neighbors[part].emplace(plan.asset.parts[part].mesh, mParts[part].vertices, mParts[part].spacing);
    const auto interpolated = [&](uint32_t block) {
        const BakeBlock& place = plan.blocks[block];
        std::vector<std::vector<CoarseNeighbor>> of;
        for (uint32_t vertex = place.first; vertex < place.end; vertex++)
            of.push_back(neighbors[place.part]->of(vertex));
        BakedBlock made;
        for (size_t set = 0; set < plan.asset.parts[place.part].sets.size(); set++) {
            const BakedRows& from = mRows[plan.firstSet[place.part] + set];
            RowInterpolator interpolator(from, 6 * faceSize * faceSize, kept);
            BakedRows& to = made.sets.emplace_back(from.transport.terms);
            for (const auto& own : of) interpolator.append(own, to);
        }
        if (plan.bounced) plan.bounced->addTo(made.sets, plan.asset, place.part, place.first, kept);
        return storeBlock(plan, block, std::move(made));
    };
    while (!blocks.empty()) {
        if (observer.wantsStop()) throw BakeStopped("stopped");
        const size_t together = std::max(1u, kVerticesTogether / plan.blockVertices);
        const auto some = blocks.first(std::min(together, blocks.size()));
        std::vector<StoredBlock> stored(some.size());
        tbb::parallel_for(size_t(0), some.size(), [&](size_t i) { stored[i] = interpolated(some[i]); });
        for (size_t i = 0; i < some.size(); i++) store(some[i], std::move(stored[i]));
        blocks = blocks.subspan(some.size());
    }
}

uint64_t CoarseRows::interpolatedBytes(const BakePlan& plan) {
    uint64_t bytes = 0;
    for (const AssetPart& part : plan.asset.parts) {
        const int rows = termCount(part);
        const int kept = std::min(plan.asset.coefficients, kMostInterpolated);
        bytes += part.mesh.vertexCount() * rowBytes(rows, uint64_t(rows) * uint64_t(kept));
    }
    return bytes;
}

RowInterpolator::RowInterpolator(const BakedRows& coarse, int coefficients, int kept)
    : mCoarse(coarse), mKept(kept), mSum(size_t(coefficients)) {}

void RowInterpolator::append(std::span<const CoarseNeighbor> neighbors, BakedRows& rows) {
    for (uint32_t term = 0; term < mCoarse.transport.terms; term++) appendSum(neighbors, term, rows);
    rows.transport.vertices++;
}

void RowInterpolator::appendSum(std::span<const CoarseNeighbor> neighbors, uint32_t term, BakedRows& rows) {
    TransportLosses losses;
    for (const CoarseNeighbor& neighbor : neighbors) {
        const size_t row = size_t(neighbor.coarse) * mCoarse.transport.terms + term;
        mSum.add(mCoarse.transport, row, neighbor.weight);
        losses.total += double(neighbor.weight) * mCoarse.losses[row].total;
        losses.dropped += double(neighbor.weight) * mCoarse.losses[row].dropped;
        losses.quantized += double(neighbor.weight) * mCoarse.losses[row].quantized;
    }
    appendRow(rows.transport, mSum.pack(mKept));
    rows.losses.push_back(losses);
}

} // namespace relume

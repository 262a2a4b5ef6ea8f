#include "precompute/bake/layout_sample.h"

#include "precompute/bake/stored_blocks.h"
#include "precompute/bake/vertex_rows.h"
#include "precompute/layout/cluster_matrix.h"
#include "precompute/layout/light_spectrum.h"

#include <algorithm>

namespace relume {

namespace {

// Of the vertices of all parts, so many or such a share; of a part's at least so many: docs/layouts.md.
constexpr uint64_t kSampleVertices = 8192, kSampleShare = 4, kLeastOfPart = 1024;
// Vertices of a part that tell its sets' units: such a share, within bounds.
constexpr uint64_t kUnitShare = 64, kLeastForUnit = 512, kMostForUnit = 4096;
constexpr uint64_t kSampleBytes = uint64_t(256) << 20; // of rows in memory

uint64_t rowBytes(const Asset& asset, const AssetPart& part) {
    uint64_t terms = 0;
    for (const MaterialSet& set : part.sets) terms += uint64_t(set.brdf.terms);
    return terms * uint64_t(asset.coefficients) * (sizeof(uint16_t) + sizeof(uint32_t));
}

class SampleSink : public BakeSink {
  public:
    explicit SampleSink(const BakePlan& plan) : mPlan(plan) {}

    void take(uint32_t block, BakedBlock baked) override {
        packVisibility(mPlan, block, baked);
        blocks.push_back({block, std::move(baked)});
    }

    std::vector<SampledBlock> blocks;

  private:
    const BakePlan& mPlan;
};

// Per set, from vertices spread over its part: a few blocks would not tell. A ground's shadow is on one in
// twenty.
std::vector<float> unitsOf(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                           BakeObserver& observer) {
    std::vector<std::vector<uint32_t>> chosen;
    for (const AssetPart& part : plan.asset.parts) {
        const uint64_t all = part.mesh.vertexCount();
        const uint64_t count = std::min(all, std::clamp(all / kUnitShare, kLeastForUnit, kMostForUnit));
        std::vector<uint32_t>& own = chosen.emplace_back();
        for (uint64_t i = 0; i < count; i++) own.push_back(uint32_t((2 * i + 1) * all / (2 * count)));
    }
    const std::vector<float> spectrum = lightSpectrum(plan.asset.faceSize);
    std::vector<float> units;
    for (const BakedRows& rows : bakeVertices(device, plan, chosen, limits, observer))
        units.push_back(transportUnit(rows.transport, spectrum));
    return units;
}

LayoutScale scaleOf(const BakePlan& plan, std::span<const SampledBlock> blocks,
                    const std::vector<float>& units) {
    std::vector<SparseTransport> rows; // over all parts
    std::vector<SetSample> samples;
    for (const AssetPart& part : plan.asset.parts)
        for (const MaterialSet& set : part.sets) {
            rows.emplace_back();
            rows.back().terms = uint32_t(set.brdf.terms);
            rows.back().rowStarts = {0};
            samples.push_back({&set, nullptr, uint32_t(part.mesh.vertexCount()), units[samples.size()]});
        }
    for (const SampledBlock& sampled : blocks) {
        const uint32_t firstSet = plan.firstSet[plan.blocks[sampled.block].part];
        for (size_t set = 0; set < sampled.baked.sets.size(); set++)
            append(rows[firstSet + set], sampled.baked.sets[set].transport);
    }
    for (size_t set = 0; set < rows.size(); set++) samples[set].rows = &rows[set];
    return findScale(samples, plan.asset.faceSize, plan.vertices(), plan.options.layout);
}

} // namespace

std::vector<uint32_t> sampleBlocks(const BakePlan& plan) {
    uint64_t bytes = 0;
    for (const AssetPart& part : plan.asset.parts)
        bytes += part.mesh.vertexCount() * rowBytes(plan.asset, part);
    const uint64_t all = plan.vertices();
    const uint64_t most = std::max<uint64_t>(1, kSampleBytes / std::max<uint64_t>(1, bytes / all));
    const uint64_t wanted = std::min({kSampleVertices, all / kSampleShare, most});
    const uint64_t leastOfPart = std::min(kLeastOfPart, most);
    std::vector<uint32_t> sample;
    for (uint32_t first = 0, part = 0; part < plan.asset.parts.size(); part++) {
        const uint64_t vertices = plan.asset.parts[part].mesh.vertexCount();
        const uint64_t blocks = (vertices + plan.blockVertices - 1) / plan.blockVertices;
        const uint64_t own = std::max(leastOfPart, wanted * vertices / all);
        const uint64_t count = std::min(blocks, (own + plan.blockVertices - 1) / plan.blockVertices);
        // The middles of so many stretches.
        for (uint64_t i = 0; i < count; i++)
            sample.push_back(first + uint32_t((2 * i + 1) * blocks / (2 * count)));
        first += uint32_t(blocks);
    }
    return sample;
}

std::vector<SampledBlock> bakeSample(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                                     BakeObserver& observer, BakeTimes& times, KeptVisibility* kept) {
    const std::vector<uint32_t> blocks = sampleBlocks(plan);
    SampleSink sink(plan);
    StageObserver sampleObserver(observer, BakeStage::Sample);
    bakeBlocks(device, plan, blocks, blocks, limits, sink, sampleObserver, times, kept);
    plan.scale = scaleOf(plan, sink.blocks, unitsOf(device, plan, limits, sampleObserver));
    return std::move(sink.blocks);
}

} // namespace relume

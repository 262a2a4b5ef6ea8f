#include "precompute/error/layout_costs.h"

#include "engine/base/check.h"
#include "engine/base/stopwatch.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/cpu/cpu_relighter.h"
#include "precompute/layout/conversion.h"
#include "precompute/reference/vertex_views.h"

#include <cmath>

namespace relume {

namespace {

constexpr uint32_t kBlocksOfPart = 6; // of a basis cluster each; errors are then known within about a tenth

// Collects blocks spread evenly over a part as continuous rows per set, and the indices of their vertices.
class RowSink : public BakeSink {
  public:
    RowSink(const BakePlan& plan, size_t part) : mPlan(plan) {
        for (const MaterialSet& set : plan.asset.parts[part].sets)
            rows.emplace_back(uint32_t(set.brdf.terms));
    }

    void take(uint32_t block, BakedBlock baked) override {
        for (size_t set = 0; set < rows.size(); set++) rows[set].append(baked.sets[set]);
        for (uint32_t vertex = mPlan.blocks[block].first; vertex < mPlan.blocks[block].end; vertex++)
            vertices.push_back(vertex);
    }

    std::vector<BakedRows> rows;
    std::vector<uint32_t> vertices;

  private:
    const BakePlan& mPlan;
};

std::vector<uint32_t> chooseBlocks(const BakePlan& plan, uint32_t part) {
    std::vector<uint32_t> all, chosen;
    for (uint32_t i = 0; i < plan.blocks.size(); i++)
        if (plan.blocks[i].part == part) all.push_back(i);
    const size_t count = std::min<size_t>(all.size(), kBlocksOfPart);
    for (size_t i = 0; i < count; i++) chosen.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
    return chosen;
}

// Returns the mean squared difference in radiance between two tuples of the same vertices, seen from the eyes
// in front of them with the weight of pixels, the cosine.
double squaredDifference(const AssetPart& part, const PartAppearance& bound,
                         std::span<const uint32_t> vertices, std::span<const vec3> a, std::span<const vec3> b,
                         std::span<const vec3> eyes) {
    const auto terms = size_t(part.sets[bound.set].brdf.terms);
    double sum = 0, weights = 0;
    for (size_t i = 0; i < vertices.size(); i++)
        for (const vec3 eye : eyes) {
            const double cosine = double(glm::dot(part.mesh.normals[vertices[i]],
                                                  glm::normalize(eye - part.mesh.positions[vertices[i]])));
            if (!(cosine > 0)) continue;
            const std::vector<vec3> views = vertexViews(part, bound, vertices[i], eye);
            glm::dvec3 first(0), second(0);
            for (size_t term = 0; term < terms; term++) {
                first += glm::dvec3(views[term] * a[i * terms + term]);
                second += glm::dvec3(views[term] * b[i * terms + term]);
            }
            const glm::dvec3 difference = glm::max(first, 0.0) - glm::max(second, 0.0);
            sum += cosine * glm::dot(difference, difference) / 3;
            weights += cosine;
        }
    return weights > 0 ? sum / weights : 0;
}

std::vector<vec3> relight(const Transport& transport, const LightVector& light, size_t rows) {
    std::vector<vec3> tuples(rows);
    makeCpuRelighter(transport)->relight(light, tuples);
    return tuples;
}

} // namespace

LayoutCosts layoutCosts(const vk::Device& device, BakePlan& plan, const Appearance& appearance,
                        const LightVector& light, std::span<const vec3> eyes, const ErrorGrid& grid,
                        BakeObserver& observer, const std::function<void(double)>& progress) {
    RELUME_CHECK(plan.options.layout.layout == TransportLayout::Bases);
    LayoutCosts costs;
    costs.bakeSeconds = plan.factorizationSeconds + plan.occluderSeconds;
    if (plan.options.bounces > 0) {
        const Stopwatch watch;
        BakeTimes times;
        plan.bounced = bounceTransport(device, plan, {}, observer, times);
        costs.bakeSeconds += watch.seconds();
    }
    std::array<double, kTriedLayoutErrors.size()> squares{};
    // A part's bake takes about as long as its encoding in bases for all errors.
    const size_t pieces = plan.asset.parts.size() * 2 * kTriedLayoutErrors.size();
    size_t done = 0;
    const auto tell = [&](size_t more) { progress(double(done += more) / double(pieces)); };
    for (uint32_t number = 0; number < plan.asset.parts.size(); number++) {
        const AssetPart& part = plan.asset.parts[number];
        const PartAppearance& bound = appearance[number];
        RowSink sink(plan, number);
        BakeTimes times;
        const std::vector<uint32_t> blocks = chooseBlocks(plan, number);
        const Stopwatch watch;
        bakeBlocks(device, plan, blocks, blocks, {}, sink, observer, times);
        const double scale = double(part.mesh.vertexCount()) / double(sink.vertices.size());
        costs.bakeSeconds += scale * watch.seconds();
        tell(kTriedLayoutErrors.size());

        // An asset of these vertices alone, encoded in bases for one error after another.
        Asset sample;
        sample.faceSize = plan.asset.faceSize;
        sample.coefficients = plan.asset.coefficients;
        sample.bounces = plan.asset.bounces;
        sample.parts.emplace_back();
        AssetPart& sampled = sample.parts.front();
        sampled.mesh.positions.resize(sink.vertices.size());
        for (size_t set = 0; set < part.sets.size(); set++)
            sampled.sets.push_back({part.sets[set].materials, part.sets[set].brdf, sink.rows[set].transport});
        const size_t tuples = sink.vertices.size() * size_t(part.sets[bound.set].brdf.terms);
        const std::vector<vec3> exact = relight(sampled.sets[bound.set].transport, light, tuples);
        for (size_t i = 0; i < kTriedLayoutErrors.size(); i++) {
            Asset bases = sample;
            LayoutOptions layout;
            layout.error = kTriedLayoutErrors[i];
            costs.bytes[i] += scale * double(convertLayout(bases, layout).bytesAfter);
            squares[i] +=
                grid.shares[number] *
                squaredDifference(part, bound, sink.vertices, exact,
                                  relight(bases.parts[0].sets[bound.set].transport, light, tuples), eyes);
            tell(1);
        }
    }
    for (size_t i = 0; i < squares.size(); i++) costs.errors[i] = std::sqrt(squares[i]) / grid.level;
    return costs;
}

} // namespace relume

// Tests one bounce of light against a closed form and against its twin.
#include "engine/math/haar.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/twins/bounce_twin.h"
#include "tests/support/bounce_scene.h"
#include "tests/support/bowl.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <tbb/global_control.h>

using namespace relume;
using namespace relume::test;

namespace {

// Rows of one coefficient, of this value.
SparseTransport constantRows(const AssetPart& part, vec3 value, size_t coefficient = 0) {
    SparseTransport rows = emptyRows(uint32_t(part.sets[0].brdf.terms));
    RowSum sum(kBounceCoefficients);
    for (size_t row = 0; row < part.mesh.vertexCount() * rows.terms; row++) {
        sum.add(coefficient, value);
        appendRow(rows, sum.pack(1));
    }
    rows.vertices = uint32_t(part.mesh.vertexCount());
    return rows;
}

} // namespace

TEST_CASE("bounce: a bowl sees itself with half of its directions") {
    Asset asset = makeTestAsset({makeDiffusePart(makeBowl(), 0.6f)});
    const BounceHits hits(asset, defaultAppearance(asset));
    const BounceGather gather(hits);
    const vec3 value(3, 2, 1);
    const std::vector<SparseTransport> from = {constantRows(asset.parts[0], value, 17)};
    const auto bounced = gather.gather(from, [](uint64_t) { return true; });
    REQUIRE(bounced.size() == 1);
    const SparseTransport& rows = bounced[0][0];
    REQUIRE(rows.vertices == asset.parts[0].mesh.vertexCount());
    double sum = 0;
    for (size_t row = 0; row < rows.rows(); row++) {
        const std::vector<vec3> dense = denseRow(rows, row);
        for (size_t i = 0; i < dense.size(); i++)
            if (i != 17) CHECK(dense[i] == vec3(0));
        // ∫ cosine over half of the directions is π/2; what leaves a point is albedo / π of its row.
        for (int channel = 0; channel < 3; channel++)
            CHECK(dense[17][channel] == doctest::Approx(0.3f * value[channel]).epsilon(0.08));
        sum += double(dense[17].x);
    }
    CHECK(sum / double(rows.rows()) == doctest::Approx(0.9).epsilon(0.005));
}

TEST_CASE("bounce: factors that reflect more than they receive light others as if it were all") {
    Asset asset = makeTestAsset({makeDiffusePart(makeBowl(), 1)});
    FactoredBrdf& brdf = asset.parts[0].sets[0].brdf;
    CHECK(glm::length(reflectedShare(brdf, 0) - vec3(1)) < 1e-3f);
    const std::vector<SparseTransport> from = {constantRows(asset.parts[0], vec3(1))};
    const auto keepOn = [](uint64_t) { return true; };
    const BounceHits hits(asset, defaultAppearance(asset));
    const BounceGather gather(hits);
    CHECK(hits.heldLayers().empty());
    const auto bounced = gather.gather(from, keepOn);
    for (vec3& value : brdf.viewMaps) value *= vec3(1.5f, 1, 0.5f);
    const BounceHits heldHits(asset, defaultAppearance(asset));
    const BounceGather held(heldHits);
    REQUIRE(heldHits.heldLayers().size() == 1);
    CHECK(heldHits.heldLayers()[0].share == doctest::Approx(1.5));
    const auto less = held.gather(from, keepOn);
    const SparseTransport &all = bounced[0][0], &found = less[0][0];
    for (size_t row = 0; row < all.rows(); row++) {
        const vec3 expected = denseRow(all, row)[0] * vec3(1, 1, 0.5f);
        CHECK(glm::length(denseRow(found, row)[0] - expected) < 2e-3f);
    }
}

TEST_CASE("bounce: rows are those of the twin, in every term and channel") {
    const Asset asset = makeBounceScene();
    const Appearance bound = defaultAppearance(asset);
    std::mt19937 random(21);
    const std::vector<SparseTransport> from = {randomRows(asset.parts[0], random),
                                               randomRows(asset.parts[1], random)};
    const BounceHits hits(asset, bound);
    const BounceGather gather(hits);
    const auto bounced = gather.gather(from, [](uint64_t) { return true; });
    const RayTracer tracer(partMeshes(asset));
    double difference = 0, all = 0;
    const auto compare = [&](size_t part, size_t set, uint32_t vertex, uint32_t term) {
        const SparseTransport& rows = bounced[part][set];
        const std::vector<vec3> found = denseRow(rows, size_t(vertex) * rows.terms + term),
                                expected = bouncedVector(asset, bound, sourceGains(asset, bound), tracer,
                                                         from, part, vertex, set, int(term), 64);
        for (size_t i = 0; i < expected.size(); i++) {
            difference += double(glm::dot(found[i] - expected[i], found[i] - expected[i]));
            all += double(glm::dot(expected[i], expected[i]));
        }
    };
    for (size_t part = 0; part < 2; part++)
        for (size_t set = 0; set < bounced[part].size(); set++)
            for (uint32_t vertex = 0; vertex < bounced[part][set].vertices; vertex += 13)
                for (uint32_t term = 0; term < bounced[part][set].terms; term++)
                    compare(part, set, vertex, term);
    REQUIRE(all > 0);
    CHECK(std::sqrt(difference / all) < 0.03); // of 1,024 rays
}

TEST_CASE("bounce: the same rows from any number of threads, and none when stopped") {
    Asset asset = makeTestAsset({makeDiffusePart(makeBowl(), 0.6f)});
    asset.parts[0].sets[0].brdf = coloredTerms(9);
    const BounceHits hits(asset, defaultAppearance(asset));
    const BounceGather gather(hits);
    std::mt19937 random(5);
    const std::vector<SparseTransport> from = {randomRows(asset.parts[0], random)};
    const auto keepOn = [](uint64_t) { return true; };
    const auto many = gather.gather(from, keepOn);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto single = gather.gather(from, keepOn);
    CHECK(many[0][0].values == single[0][0].values);
    CHECK(many[0][0].indices == single[0][0].indices);
    CHECK(many[0][0].scales == single[0][0].scales);
    CHECK(many[0][0].rowStarts == single[0][0].rowStarts);
    CHECK(many[0][0].vertices == asset.parts[0].mesh.vertexCount());
    CHECK(gather.gather(from, [](uint64_t) { return false; }).empty());
}

TEST_CASE("bounce: surfaces are black from behind") {
    // A lid that shows its back to the bowl, and hides half of it from itself no more than before.
    Mesh lid = makeQuad({-2, 0.2f, -2}, {0, 0, 4}, {4, 0, 0}); // normals up
    Asset asset = makeTestAsset({makeDiffusePart(makeBowl(), 0.6f), makeDiffusePart(lid, 0.9f)});
    const BounceHits hits(asset, defaultAppearance(asset));
    const BounceGather gather(hits);
    const std::vector<SparseTransport> from = {constantRows(asset.parts[0], vec3(0)),
                                               constantRows(asset.parts[1], vec3(1))};
    const auto bounced = gather.gather(from, [](uint64_t) { return true; });
    for (size_t row = 0; row < bounced[0][0].rows(); row++)
        for (const vec3& value : denseRow(bounced[0][0], row)) CHECK(value == vec3(0));
}

TEST_CASE("bounce: coefficients of a coarser cube are those of a finer one, times the ratio of their sides") {
    constexpr int kFine = 64, kRatio = kFine / kBounceFaceSize;
    std::vector<vec3> coarse(kBounceFaceSize * kBounceFaceSize), fine(kFine * kFine);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> amount(-1, 1);
    // Transport of a coarse texel is the sum of that of the fine ones.
    for (vec3& value : coarse) value = {amount(random), amount(random), amount(random)};
    for (int y = 0; y < kFine; y++)
        for (int x = 0; x < kFine; x++)
            fine[size_t(y * kFine + x)] =
                coarse[size_t(y / kRatio * kBounceFaceSize + x / kRatio)] / float(kRatio * kRatio);
    haarForward(coarse, kBounceFaceSize);
    haarForward(fine, kFine);
    for (uint16_t i = 0; i < coarse.size(); i++) {
        const uint16_t at = coefficientOfBounce(i, kFine);
        const vec3 expected = coarse[i] * float(kBounceFaceSize) / float(kFine);
        CHECK(glm::length(fine[at] - expected) < 1e-5f);
        CHECK(bounceCoefficient(at, kFine) == i);
        fine[at] = vec3(0);
    }
    for (const vec3& rest : fine) CHECK(glm::length(rest) < 1e-5f);
    CHECK(!bounceCoefficient(kBounceFaceSize, kFine));
    CHECK(coefficientOfBounce(kBounceFaceSize * kBounceFaceSize + 1, kFine) == kFine * kFine + 1);
}

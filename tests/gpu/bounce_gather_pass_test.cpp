// Bounced light gathered on the device against the CPU's.
#include "precompute/bounce/bounce_gather_pass.h"
#include "tests/support/bounce_scene.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

const BounceReport kGoOn = [](uint64_t) { return true; };

// Σ |a - b|² and Σ |b|² over all coefficients.
std::pair<double, double> differenceOf(const SparseTransport& a, const SparseTransport& b) {
    REQUIRE(a.terms == b.terms);
    REQUIRE(a.vertices == b.vertices);
    double difference = 0, all = 0;
    for (size_t row = 0; row < b.rows(); row++) {
        const std::vector<vec3> found = denseRow(a, row), expected = denseRow(b, row);
        for (size_t i = 0; i < expected.size(); i++) {
            difference += double(glm::dot(found[i] - expected[i], found[i] - expected[i]));
            all += double(glm::dot(expected[i], expected[i]));
        }
    }
    return {difference, all};
}

} // namespace

TEST_CASE("bounce gather pass: gathers the CPU's rows, in every set, term and channel") {
    const TestDevice device;
    const Asset asset = makeBounceScene(6, 4);
    const BounceHits hits(asset, defaultAppearance(asset));
    std::mt19937 random(21);
    // These are fewer and more than bounced rows keep, of many terms and of one.
    for (const int coefficients : {8, 200, 1000}) {
        CAPTURE(coefficients);
        const std::vector<SparseTransport> from = {randomRows(asset.parts[0], random, coefficients),
                                                   randomRows(asset.parts[1], random, coefficients)};
        const auto expected = BounceGather(hits).gather(from, kGoOn);
        BounceGatherPass pass(device, hits);
        const auto found = pass.gather(from, kGoOn);
        for (size_t part = 0; part < 2; part++)
            for (size_t set = 0; set < expected[part].size(); set++) {
                const auto [difference, all] = differenceOf(found[part][set], expected[part][set]);
                REQUIRE(all > 0);
                // Coefficients that are nearly alike change places at the last one kept.
                CHECK(std::sqrt(difference / all) < (coefficients == 8 ? 3e-4 : 2e-3));
            }
    }
}

TEST_CASE("bounce gather pass: sources of any size keep their precision, and none give none") {
    const TestDevice device;
    const Asset asset = makeBounceScene(6, 4);
    const BounceHits hits(asset, defaultAppearance(asset));
    std::mt19937 random(4);
    std::vector<SparseTransport> from = {randomRows(asset.parts[0], random),
                                         randomRows(asset.parts[1], random)};
    BounceGatherPass pass(device, hits);
    for (const float scale : {1e-12f, 1e9f, 0.0f}) {
        CAPTURE(scale);
        std::vector<SparseTransport> scaled = from;
        for (SparseTransport& rows : scaled)
            for (float& value : rows.scales) value *= scale;
        const auto expected = BounceGather(hits).gather(scaled, kGoOn);
        const auto found = pass.gather(scaled, kGoOn);
        const auto [difference, all] = differenceOf(found[0][1], expected[0][1]);
        CHECK(std::sqrt(difference) <= 3e-4 * std::sqrt(all));
        CHECK((all > 0) == (scale > 0));
    }
}

TEST_CASE("bounce gather pass: stops when asked to") {
    const TestDevice device;
    const Asset asset = makeBounceScene(6, 4);
    const BounceHits hits(asset, defaultAppearance(asset));
    std::mt19937 random(4);
    const std::vector<SparseTransport> from = {randomRows(asset.parts[0], random),
                                               randomRows(asset.parts[1], random)};
    CHECK(BounceGatherPass(device, hits).gather(from, [](uint64_t) { return false; }).empty());
}

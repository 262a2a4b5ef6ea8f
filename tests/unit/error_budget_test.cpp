// Tests how errors add up and are attributed to sources, and low-order light.
#include "precompute/error/error_budget.h"
#include "precompute/error/low_order_light.h"

#include "engine/math/cubemap.h"

#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

// Each source changes a point by a number of its own.
std::vector<StageRadiance> randomStages(size_t points, std::span<const float> sizes) {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss;
    std::vector<StageRadiance> stages(points);
    for (StageRadiance& point : stages) {
        point[kErrorSources] = vec3(3 + gauss(random));
        for (size_t i = kErrorSources; i-- > 0;)
            point[i] = point[i + 1] + sizes[i] * vec3(gauss(random), gauss(random), gauss(random));
    }
    return stages;
}

constexpr std::array<float, kErrorSources> kSizes = {0, 0.5f, 0, 0.1f, 0.3f, 1, 0, 0, 0.2f, 0, 0.05f, 0, 0};

} // namespace

TEST_CASE("error budget: shares sum to one, and independent sources to the total") {
    const ErrorBudget budget = errorBudget(randomStages(20000, kSizes));
    double shares = 0, squares = 0;
    for (size_t i = 0; i < kErrorSources; i++) {
        shares += budget.sources[i].share;
        squares += budget.sources[i].rms * budget.sources[i].rms;
        CHECK(budget.sources[i].rms * budget.level == doctest::Approx(double(kSizes[i])).epsilon(0.03));
    }
    CHECK(shares == doctest::Approx(1).epsilon(1e-9));
    CHECK(budget.rootSumSquares == doctest::Approx(std::sqrt(squares)));
    CHECK(budget.total == doctest::Approx(budget.rootSumSquares).epsilon(0.03));
    CHECK(budget.sources[5].share == doctest::Approx(1 / 1.3925).epsilon(0.05)); // of the sizes, squared
}

TEST_CASE("error budget: its uncertainty is that of samples") {
    const std::vector<StageRadiance> all = randomStages(40000, kSizes);
    constexpr size_t kSample = 400;
    const double truth = errorBudget(all).total;
    double squares = 0, told = 0;
    for (size_t first = 0; first < all.size(); first += kSample) {
        const ErrorBudget budget = errorBudget(std::span(all).subspan(first, kSample));
        squares += (budget.total - truth) * (budget.total - truth);
        told += budget.uncertainty;
    }
    const double samples = double(all.size() / kSample);
    CHECK(told / samples == doctest::Approx(std::sqrt(squares / samples)).epsilon(0.25));
}

TEST_CASE("error budget: opposite changes have shares of opposite sign") {
    StageRadiance point;
    point.fill(vec3(1));
    point[0] = vec3(1.5f), point[1] = vec3(0.75f); // down by .75, up by .25
    const ErrorBudget budget = errorBudget(std::span(&point, 1));
    CHECK(budget.total == doctest::Approx(0.5));
    CHECK(budget.sources[0].share == doctest::Approx(1.5));
    CHECK(budget.sources[1].share == doctest::Approx(-0.5));
}

TEST_CASE("error budget: nothing, black and exact points are no reason to divide by zero") {
    CHECK(errorBudget({}).total == 0);
    StageRadiance point;
    point.fill(vec3(0));
    CHECK(errorBudget(std::span(&point, 1)).total == 0);
    point.fill(vec3(2));
    const ErrorBudget budget = errorBudget(std::span(&point, 1));
    CHECK(budget.total == 0);
    CHECK(budget.level == doctest::Approx(2));
    CHECK(budget.uncertainty == 0);
    CHECK(budget.sources[0].share == 0);
}

namespace {

template <typename Value>
LightCube cubeOf(int size, const Value& value) {
    LightCube cube{size, {}};
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++)
                cube.radiance.push_back(value(cubeTexelDirection(face, x, y, size)));
    return cube;
}

double largestDifference(const LightCube& a, const LightCube& b) {
    double largest = 0;
    for (size_t i = 0; i < a.radiance.size(); i++)
        largest = std::max(largest, double(glm::length(a.radiance[i] - b.radiance[i])));
    return largest;
}

} // namespace

TEST_CASE("low-order light: polynomials of low degree stay, those of higher degree go") {
    const auto low = [](vec3 d) {
        return vec3(1 + d.x * d.y - 0.5f * d.z, d.x * d.x * d.y * d.y, d.y * d.z);
    };
    CHECK(largestDifference(lowOrderLight(cubeOf(64, low), 5), cubeOf(64, low)) < 2e-3);
    // Re (x + iy)⁵ is a harmonic of degree 5.
    const auto high = [](vec3 d) {
        return vec3(d.x * d.x * d.x * d.x * d.x - 10 * d.x * d.x * d.x * d.y * d.y +
                    5 * d.x * d.y * d.y * d.y * d.y);
    };
    const LightCube black = cubeOf(64, [](vec3) { return vec3(0); });
    CHECK(largestDifference(lowOrderLight(cubeOf(64, high), 5), black) < 2e-3);
    CHECK(largestDifference(lowOrderLight(cubeOf(64, high), 6), cubeOf(64, high)) < 2e-3);
}

TEST_CASE("low-order light: a small lamp becomes as broad as 25 coefficients leave it") {
    LightCube lamp = cubeOf(32, [](vec3) { return vec3(0); });
    const int texel = cubeTexelIndex(2, 16, 16, 32);
    lamp.radiance[size_t(texel)] = vec3(1 / cubeTexelSolidAngle(16, 16, 32));
    const LightCube low = lowOrderLight(lamp, 5);
    // Σ (2l + 1) / 4π towards it, by the addition theorem.
    CHECK(double(low.radiance[size_t(texel)].x) == doctest::Approx(25 / (4 * double(kPi))).epsilon(1e-3));
    CHECK(double(lowOrderLight(lamp, 16).radiance[size_t(texel)].x) ==
          doctest::Approx(256 / (4 * double(kPi))).epsilon(1e-3));
    double energy = 0, least = 0;
    for (int i = 0; i < 6 * 32 * 32; i++) {
        energy += double(low.radiance[size_t(i)].x * cubeTexelSolidAngle(i % 32, i / 32 % 32, 32));
        least = std::min(least, double(low.radiance[size_t(i)].x));
    }
    CHECK(energy == doctest::Approx(1).epsilon(1e-3));
    CHECK(least < -0.1); // it rings
}

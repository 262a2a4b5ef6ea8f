// Tests directions sampled from a light against its energy.
#include "precompute/reference/light_distribution.h"

#include "engine/math/cubemap.h"
#include "engine/math/hashed_numbers.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr int kSize = 4, kTexels = 6 * kSize * kSize;

// Dark, dim and bright texels in turn.
LightCube makeLight() {
    LightCube light{kSize, {}};
    for (int i = 0; i < kTexels; i++)
        light.radiance.push_back(i % 7 == 0   ? vec3(0)
                                 : i % 7 == 3 ? vec3(9, 1, float(i))
                                              : vec3(0, float(i % 5) * 0.1f, 0));
    return light;
}

} // namespace

TEST_CASE("light distribution: texels are drawn by their energy, directions uniformly on them") {
    const LightCube light = makeLight();
    const LightDistribution distribution(light);
    HashedNumbers random(1, 2);
    std::vector<double> energies, drawn(kTexels, 0.0);
    double sum = 0;
    for (int i = 0; i < kTexels; i++) {
        const vec3 radiance = light.radiance[size_t(i)];
        energies.push_back(double(radiance.x + radiance.y + radiance.z) *
                           double(cubeTexelSolidAngle(i % kSize, i / kSize % kSize, kSize)));
        sum += energies.back();
    }
    constexpr int kDraws = 200000;
    glm::dvec3 energy(0), expected(0); // ∫ radiance, by weighed draws and by texels
    for (int i = 0; i < kTexels; i++)
        expected += glm::dvec3(light.radiance[size_t(i)]) *
                    double(cubeTexelSolidAngle(i % kSize, i / kSize % kSize, kSize));
    for (int i = 0; i < kDraws; i++) {
        const float across = random.next(), down = random.next();
        const auto [direction, texel] =
            distribution.draw((double(i) + double(random.next())) / kDraws, across, down);
        REQUIRE(distribution.texelOf(direction) == texel);
        drawn[texel]++;
        energy += glm::dvec3(distribution.radiance(texel) / distribution.density(direction, texel));
    }
    for (size_t i = 0; i < kTexels; i++) CHECK(std::abs(drawn[i] - kDraws * energies[i] / sum) < 2);
    // Texels of 22 degrees are larger or smaller than by the midpoint rule.
    CHECK(glm::length(energy / double(kDraws) - expected) < 0.02 * glm::length(expected));
}

TEST_CASE("light distribution: densities integrate to one") {
    const LightDistribution distribution(makeLight());
    constexpr int kFine = 64;
    double sum = 0;
    for (int i = 0; i < 6 * kFine * kFine; i++) {
        const int x = i % kFine, y = i / kFine % kFine;
        const vec3 direction = cubeTexelDirection(i / (kFine * kFine), x, y, kFine);
        sum += double(distribution.density(direction, distribution.texelOf(direction)) *
                      cubeTexelSolidAngle(x, y, kFine));
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("light distribution: the ends of the range, one lit texel, none") {
    LightCube light{kSize, std::vector<vec3>(kTexels, vec3(0))};
    CHECK(LightDistribution(light).isBlack());
    light.radiance[37] = vec3(0, 0, 1e-20f);
    const LightDistribution distribution(light);
    CHECK_FALSE(distribution.isBlack());
    for (double choice : {0.0, 0.3, 1 - 0x1p-40}) CHECK(distribution.draw(choice, 0.5f, 0.5f).texel == 37);
}

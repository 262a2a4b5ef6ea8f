#include "engine/light/light_vector.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <span>

using namespace relume;

namespace {

LightCube randomCube(int size, unsigned seed) {
    std::mt19937 random(seed);
    std::exponential_distribution<float> radiance;
    LightCube cube{size, std::vector<vec3>(size_t(6 * size * size))};
    for (vec3& texel : cube.radiance) texel = {radiance(random), radiance(random), radiance(random)};
    return cube;
}

// A cube whose Haar coefficients are those given.
LightCube cubeOfCoefficients(std::vector<vec3> coefficients, int size) {
    const size_t texels = size_t(size * size);
    for (size_t face = 0; face < 6; face++)
        haarInverse(std::span(coefficients).subspan(face * texels, texels), size);
    return {size, std::move(coefficients)};
}

uint64_t largestChannelSum(const LightVector& vector) {
    uint64_t sums[3] = {};
    for (const auto& value : vector.values)
        for (size_t c = 0; c < 3; c++) sums[c] += uint64_t(std::abs(int(value[c])));
    return std::max({sums[0], sums[1], sums[2]});
}

double relativeError(const LightCube& a, const LightCube& b) {
    double squares = 0, reference = 0;
    for (size_t i = 0; i < a.radiance.size(); i++) {
        const vec3 difference = a.radiance[i] - b.radiance[i];
        squares += glm::dot(difference, difference);
        reference += glm::dot(b.radiance[i], b.radiance[i]);
    }
    return std::sqrt(squares / reference);
}

} // namespace

TEST_CASE("light vector: constant light is one coefficient a face") {
    LightCube cube{64, std::vector<vec3>(6 * 64 * 64, vec3(1, 0.5f, 0.25f))};
    const LightVector vector = makeLightVector(cube);
    REQUIRE(vector.indices.size() == 6);
    for (size_t face = 0; face < 6; face++) {
        CHECK(vector.indices[face] == face * 64 * 64);
        CHECK(vector.values[face] == std::array<int16_t, 3>{16384, 8192, 4096});
    }
    CHECK(vector.scale == 64.0f / 16384);
}

TEST_CASE("light vector: black light is empty") {
    const LightVector vector = makeLightVector({16, std::vector<vec3>(6 * 16 * 16, vec3(0))});
    CHECK(vector.indices.empty());
    CHECK(vector.scale == 0);
    CHECK(relativeError(reconstruct(vector), {16, std::vector<vec3>(6 * 16 * 16, vec3(1))}) == 1);
}

TEST_CASE("light vector: rounds halves away from zero and drops below the threshold in all channels") {
    std::vector<vec3> coefficients(6 * 4 * 4, vec3(0));
    coefficients[0] = vec3(32767, 0, 0);
    coefficients[1] = vec3(1023.5f, 0, -2.5f); // 1024, 0, -3
    coefficients[2] = vec3(-1023.4f, 1023.4f, 0);
    coefficients[3] = vec3(0, 0, -4096);
    const LightVector vector = makeLightVector(cubeOfCoefficients(coefficients, 4), {1024});
    REQUIRE(vector.indices == std::vector<uint16_t>{0, 1, 3});
    CHECK(vector.values[1] == std::array<int16_t, 3>{1024, 0, -3});
    CHECK(vector.values[2] == std::array<int16_t, 3>{0, 0, -4096});
    CHECK(makeLightVector(cubeOfCoefficients(coefficients, 4), {0}).indices.size() == 4);
}

TEST_CASE("light vector: threshold 0 loses only to rounding") {
    const LightCube cube = randomCube(32, 4);
    const LightVector vector = makeLightVector(cube, {0});
    CHECK(std::is_sorted(vector.indices.begin(), vector.indices.end()));
    CHECK(relativeError(reconstruct(vector), cube) < 2e-3);
}

TEST_CASE("light vector: a higher threshold keeps less and errs more") {
    LightCube cube = randomCube(32, 5);
    cube.radiance[1000] = vec3(500);
    const LightVector fine = makeLightVector(cube, {16}), coarse = makeLightVector(cube, {1024});
    CHECK(fine.indices.size() > 2 * coarse.indices.size());
    CHECK(relativeError(reconstruct(fine), cube) < relativeError(reconstruct(coarse), cube));
}

TEST_CASE("light vector: a count keeps the largest, of equals the first") {
    std::vector<vec3> coefficients(6 * 4 * 4, vec3(0));
    coefficients[3] = coefficients[40] = vec3(0, -5, 0);
    coefficients[90] = coefficients[17] = coefficients[20] = vec3(2, 1, 0);
    coefficients[50] = vec3(0, 1, 0);
    const LightCube cube = cubeOfCoefficients(coefficients, 4);
    const auto kept = [&](int count) {
        return makeLightVector(cube, {.count = count, .areaWeighted = false}).indices;
    };
    CHECK(kept(1) == std::vector<uint16_t>{3});
    CHECK(kept(2) == std::vector<uint16_t>{3, 40});
    CHECK(kept(4) == std::vector<uint16_t>{3, 17, 20, 40});
    CHECK(kept(96) == std::vector<uint16_t>{3, 17, 20, 40, 50, 90});
}

TEST_CASE("light vector: area weighting prefers coarse functions") {
    std::vector<vec3> coefficients(6 * 8 * 8, vec3(0));
    const uint16_t average = 0, coarse = 8 + 1, middle = 2 * 8 + 1, fine = 64 + 8 + 4;
    coefficients[average] = vec3(1);
    coefficients[coarse] = vec3(1.5f);
    coefficients[middle] = vec3(3.9f); // covers a quarter
    coefficients[fine] = vec3(15);     // covers a sixteenth
    const LightCube cube = cubeOfCoefficients(coefficients, 8);
    const auto kept = [&](int count, bool areaWeighted) {
        return makeLightVector(cube, {.count = count, .areaWeighted = areaWeighted}).indices;
    };
    CHECK(kept(1, false) == std::vector<uint16_t>{fine});
    CHECK(kept(1, true) == std::vector<uint16_t>{coarse});
    CHECK(kept(2, true) == std::vector<uint16_t>{average, coarse});
    CHECK(kept(3, true) == std::vector<uint16_t>{average, coarse, middle});
    // By threshold as well, of the largest weight: 1.5.
    CHECK(makeLightVector(cube, {.threshold = 32767 / 2, .areaWeighted = true}).indices.size() == 4);
    CHECK(makeLightVector(cube, {.threshold = 31000, .areaWeighted = true}).indices.size() == 1);
    // Unless it is said a count is weighted, and a threshold is not.
    CHECK(makeLightVector(cube, {.count = 1}).indices == std::vector<uint16_t>{coarse});
    CHECK(makeLightVector(cube, {.threshold = 31000}).indices == std::vector<uint16_t>{fine});
}

TEST_CASE("light vector: the error is what reconstruction misses") {
    const LightCube cube = randomCube(32, 8);
    for (const LightSelection& selection : std::initializer_list<LightSelection>{
             {.threshold = 0}, {.threshold = 1024}, {.count = 100}, {.count = 100, .areaWeighted = true}}) {
        const LightVector vector = makeLightVector(cube, selection);
        CHECK(vector.error == doctest::Approx(relativeError(reconstruct(vector), cube)).epsilon(1e-3));
    }
}

TEST_CASE("light vector: scaled light scales the vector") {
    LightCube cube = randomCube(16, 6);
    const LightVector once = makeLightVector(cube);
    for (vec3& texel : cube.radiance) texel *= 4.0f;
    const LightVector fourfold = makeLightVector(cube);
    CHECK(once.indices == fourfold.indices);
    CHECK(once.values == fourfold.values);
    CHECK(fourfold.scale == 4 * once.scale);
}

TEST_CASE("light vector: the step is the smallest power of two that fits the largest component") {
    const auto scaleOf = [](float largest) {
        std::vector<vec3> coefficients(6 * 4 * 4, vec3(0));
        coefficients[5].y = -largest; // a detail of one level: exactly representable after the inverse
        return makeLightVector(cubeOfCoefficients(coefficients, 4)).scale;
    };
    CHECK(scaleOf(32767) == 1);
    CHECK(scaleOf(std::nextafter(32767.0f, 1e9f)) == 2);
    CHECK(scaleOf(16383.5f) == 0.5f);
    CHECK(scaleOf(std::nextafter(16383.5f, 1e9f)) == 1);
    CHECK(scaleOf(0x1p-80f) == 0x1p-94f);
    CHECK(scaleOf(0x1p100f) == 0x1p86f);
    CHECK(scaleOf(0x1p-92f) == 0); // next to no light is none
}

TEST_CASE("light vector: sums stay below the limit for hostile cubes") {
    std::mt19937 random(7);
    for (float value : {1.0f, 0.5f, 1024.5f / 32767, 85.49f / 32767, 1e-3f}) {
        std::vector<vec3> coefficients(kMaximumLightEntries);
        for (vec3& c : coefficients) c = vec3(random() % 2 ? value : -value);
        coefficients[0] = vec3(1);
        const LightCube cube = cubeOfCoefficients(coefficients, 64);
        const LightVector vector = makeLightVector(cube, {0});
        CHECK(vector.values.size() == kMaximumLightEntries);
        CHECK(largestChannelSum(vector) <= kLightSumLimit);
        CHECK(largestChannelSum(vector) >
              0.49 * std::min(double(kLightSumLimit), double(value) * 16384 * kMaximumLightEntries));
        CHECK(relativeError(reconstruct(vector), cube) < 0.01);
    }
}

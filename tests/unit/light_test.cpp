#include "engine/light/cap.h"
#include "engine/light/light.h"
#include "engine/math/cubemap.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

// Σ radiance · solid angle of the first channel.
double cubeIrradiance(const LightCube& cube) {
    double sum = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < cube.size; y++)
            for (int x = 0; x < cube.size; x++)
                sum += double(cube.radiance[size_t(cubeTexelIndex(face, x, y, cube.size))].x) *
                       double(cubeTexelSolidAngle(x, y, cube.size));
    return sum;
}

float largestDistance(const LightCube& a, const LightCube& b) {
    float largest = 0;
    for (size_t i = 0; i < a.radiance.size(); i++)
        largest = std::max(largest, glm::distance(a.radiance[i], b.radiance[i]));
    return largest;
}

float largestRadiance(const LightCube& cube) {
    float largest = 0;
    for (const vec3& radiance : cube.radiance) largest = std::max(largest, radiance.x);
    return largest;
}

std::vector<vec3> directions() {
    std::vector<vec3> list = {{0, 1, 0}, {1, 1, 1}, {1, 1, 0.999f}, {-1, 1, 0.3f}, {0.2f, -0.7f, -0.7f}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> coordinate(-1, 1);
    for (int i = 0; i < 40; i++) list.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return list;
}

// No texel of `lightAt(direction)` changes by more than `share` of the largest along a path over faces'
// inside, an edge and past a corner, in steps of a fiftieth of a texel.
template <typename LightAt>
void checkSmooth(int size, float share, LightAt lightAt) {
    LightCube last = lightAt(vec3(1, 0.9f, 0.4f));
    const int steps = 50 * size;
    for (int step = 1; step <= steps; step++) {
        const float along = float(step) / float(steps);
        const LightCube next = lightAt(vec3(1, 0.9f + 0.15f * along, 0.4f + 0.7f * along));
        const float jump = largestDistance(last, next) / largestRadiance(last);
        CAPTURE(step);
        REQUIRE(jump < share);
        last = next;
    }
}

} // namespace

TEST_CASE("light: a lamp has the energy of its solid angle, whatever its size and place") {
    for (float radius : {1e-6f, 1e-4f, 0.00465f, 0.05f, 0.5f, 2.0f, kPi})
        for (vec3 direction : directions()) {
            const LightCube cube = sampleLight({.lamps = {{direction, radius, vec3(5)}}}, 16);
            const double solidAngle = 4 * kPi * std::pow(std::sin(radius / 2.0), 2);
            CHECK(cubeIrradiance(cube) == doctest::Approx(5 * solidAngle).epsilon(1e-5));
        }
}

TEST_CASE("light: a lamp fills its inside, and nothing outside") {
    const vec3 center = glm::normalize(vec3(1, 2, 3));
    const float radius = 0.3f, margin = 0.06f;
    const LightCube cube = sampleLight({.lamps = {{3.0f * center, radius, vec3(5)}}}, 32);
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < 32; y++)
            for (int x = 0; x < 32; x++) {
                const float angle = std::acos(glm::dot(cubeTexelDirection(face, x, y, 32), center));
                const float value = cube.radiance[size_t(cubeTexelIndex(face, x, y, 32))].x;
                if (angle < radius - margin) CHECK(value == doctest::Approx(5).epsilon(0.01));
                if (angle > radius + margin) CHECK(value == 0);
            }
}

TEST_CASE("light: a cap's coverage is its area") {
    // A texel's share of discs that cross it, against many more sub-cells.
    for (float offset : {-0.04f, -0.01f, 0.0f, 0.013f, 0.05f}) {
        const shared::LightCap cap = makeCap({1, 0.31f + offset, 0.2f}, 0.2f, 0, 16);
        shared::LightCap fine = cap;
        fine.side = 200;
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 16; x++)
                CHECK(std::abs(capCoverage(cap, 0, x, y, 16) - capCoverage(fine, 0, x, y, 16)) < 0.02f);
    }
}

TEST_CASE("light: small lamps move smoothly over texels, edges and corners") {
    checkSmooth(16, 0.15f, [](vec3 d) { return sampleLight({.lamps = {{d, 0.00465f, vec3(1)}}}, 16); });
    checkSmooth(16, 0.06f, [](vec3 d) { return sampleLight({.lamps = {{d, 0.1f, vec3(1)}}}, 16); });
}

TEST_CASE("light: a distant light keeps its irradiance, on four texels at most") {
    for (vec3 direction : directions()) {
        const LightCube cube = sampleLight({.distant = {{direction, vec3(2, 3, 4)}}}, 16);
        CHECK(cubeIrradiance(cube) == doctest::Approx(2).epsilon(1e-5));
        int lit = 0;
        vec3 middle(0);
        for (int face = 0; face < kCubeFaces; face++)
            for (int y = 0; y < 16; y++)
                for (int x = 0; x < 16; x++) {
                    const float value = cube.radiance[size_t(cubeTexelIndex(face, x, y, 16))].x;
                    lit += value > 0;
                    middle += value * cubeTexelSolidAngle(x, y, 16) * cubeTexelDirection(face, x, y, 16);
                }
        CHECK(lit <= 4);
        CHECK(glm::distance(glm::normalize(middle), glm::normalize(direction)) < 0.03f); // a texel: 0.125
    }
}

TEST_CASE("light: distant lights move smoothly over texels, edges and corners") {
    checkSmooth(16, 0.1f, [](vec3 d) { return sampleLight({.distant = {{d, vec3(1)}}}, 16); });
}

TEST_CASE("light: distant lights on the same texel add up") {
    const DistantLight one{{0.2f, 0.3f, 1}, vec3(1)}, other{{0.21f, 0.3f, 1}, vec3(2)};
    const std::vector<shared::LightTap> taps = distantTaps(std::vector{one, other, one}, 32);
    for (size_t i = 1; i < taps.size(); i++) CHECK(taps[i - 1].texel < taps[i].texel);
    CHECK(cubeIrradiance(sampleLight({.distant = {one, other, one}}, 32)) == doctest::Approx(4));
    CHECK(distantTaps({}, 32).empty());
}

TEST_CASE("light: strokes cover what is below them, in their order, and lamps shine over them") {
    const auto gray = std::make_shared<const Environment>(Environment{4, 2, std::vector<vec3>(8, vec3(1))});
    const vec3 up(0, 1, 0);
    Light light{.environments = {{gray}}};
    light.strokes = {{up, 0.6f, {0, 4, 0}, 0, 1}, {up, 0.3f, {0, 0, 8}, 0, 0.25f}};
    light.lamps = {{up, 0.1f, vec3(100)}};
    const LightCube cube = sampleLight(light, 32);
    const auto at = [&](vec3 d) {
        const CubeTexel texel = cubeTexel(d, 32);
        return cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, 32))];
    };
    const auto isNear = [](vec3 a, vec3 b) { return glm::distance(a, b) < 0.01f * glm::length(b); };
    CHECK(isNear(at({1, 0, 0}), vec3(1)));
    CHECK(isNear(at({0.45f, 1, 0}), vec3(0, 4, 0)));
    CHECK(isNear(at({0.2f, 1, 0}), vec3(0, 3, 2)));
    CHECK(isNear(at({0.03f, 1, 0.03f}), vec3(100, 103, 102)));
}

TEST_CASE("light: a soft stroke fades over its radius") {
    const LightCube cube = sampleLight({.strokes = {{{1, 0, 0}, 0.8f, vec3(1), 1, 1}}}, 64);
    float last = 2;
    for (int x = 32; x < 64; x++) {
        const float value = cube.radiance[size_t(cubeTexelIndex(0, x, 32, 64))].x;
        CHECK(value <= last);
        last = value;
    }
    // Halfway, as unit vectors go.
    const float middle = 2 * std::sin(0.2f), u = std::tan(2 * std::asin(middle / 2));
    CHECK(cube.radiance[size_t(cubeTexelIndex(0, int(32 + 32 * u), 32, 64))].x ==
          doctest::Approx(0.5).epsilon(0.05));
}

TEST_CASE("light: a blend is between its environments, and scaling and turning commute with sampling") {
    Environment map{64, 32, std::vector<vec3>(64 * 32)};
    for (size_t i = 0; i < map.radiance.size(); i++) map.radiance[i] = vec3(float(i % 7), 1, float(i % 64));
    const auto first = std::make_shared<const Environment>(prepareForSampling(map));
    const auto second = std::make_shared<const Environment>(Environment{4, 2, std::vector<vec3>(8, vec3(9))});
    Light light{.environments = {{first, 0.2f, 0.75f}, {second, 0, 0.25f}}};
    const LightCube cube = sampleLight(light, 16), alone = sampleEnvironment(*first, 16, 0.2f);
    for (size_t i = 0; i < cube.radiance.size(); i++)
        CHECK(glm::distance(cube.radiance[i], 0.75f * alone.radiance[i] + 2.25f) < 1e-4f);

    light.strokes = {{{0, 0.2f, 1}, 0.4f, vec3(7), 0.2f, 0.5f}};
    light.lamps = {{{0, 0.1f, 1}, 0.2f, vec3(3)}};
    light.distant = {{{0.1f, 0.2f, 1}, vec3(2)}};
    const LightCube once = sampleLight(light, 16), twice = sampleLight(scaled(light, 2), 16);
    for (size_t i = 0; i < once.radiance.size(); i++)
        CHECK(glm::distance(2.0f * once.radiance[i], twice.radiance[i]) < 1e-3f);
    // A quarter turn moves the faces +Z and -X to +X and +Z.
    const LightCube quarter = sampleLight(turned(light, kPi / 2), 16);
    for (size_t i = 0; i < 256; i++) {
        CHECK(glm::distance(quarter.radiance[i], once.radiance[4 * 256 + i]) < 0.05f);
        CHECK(glm::distance(quarter.radiance[4 * 256 + i], once.radiance[256 + i]) < 0.05f);
    }
}

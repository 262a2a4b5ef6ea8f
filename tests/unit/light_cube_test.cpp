#include "engine/light/light_cube.h"
#include "engine/light/light_footprint.h"
#include "engine/math/cubemap.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

// Σ radiance · solid angle of the first channel.
double irradianceSum(const LightCube& cube) {
    double sum = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < cube.size; y++)
            for (int x = 0; x < cube.size; x++)
                sum += double(cube.radiance[size_t(cubeTexelIndex(face, x, y, cube.size))].x) *
                       double(cubeTexelSolidAngle(x, y, cube.size));
    return sum;
}

Environment black(int width) {
    return {width, width / 2, std::vector<vec3>(size_t(width * (width / 2)), vec3(0))};
}

double pixelSolidAngle(const Environment& map, int row) {
    const double pi = std::acos(-1.0);
    return 2 * pi / map.width * (std::cos(pi * row / map.height) - std::cos(pi * (row + 1) / map.height));
}

vec3 radianceTowards(const LightCube& cube, vec3 direction) {
    const CubeTexel texel = cubeTexel(direction, cube.size);
    return cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, cube.size))];
}

} // namespace

TEST_CASE("light cube: constant light stays constant") {
    Environment map = black(64);
    for (vec3& pixel : map.radiance) pixel = vec3(1, 2, 3);
    const LightCube cube = sampleEnvironment(prepareForSampling(map), 16, 1.0f);
    for (const vec3& texel : cube.radiance) CHECK(glm::length(texel - vec3(1, 2, 3)) < 1e-4f);
}

TEST_CASE("light cube: a linear map's texels hold the mean over the texel") {
    // Radiance 2 + y: over texels the mean of y, known by symmetry to average to zero over the cube.
    Environment map = black(512);
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++)
            map.radiance[size_t(y * map.width + x)] =
                vec3(2 + map.direction(float(x) + 0.5f, float(y) + 0.5f).y);
    const LightCube cube = sampleEnvironment(prepareForSampling(map), 16, 0);
    CHECK(irradianceSum(cube) == doctest::Approx(8 * kPi).epsilon(1e-3));
    for (int face = 0; face < kCubeFaces; face++)
        for (int i = 0; i < 16; i++) {
            const float expected = 2 + cubeTexelDirection(face, i, 15 - i, 16).y;
            CHECK(cube.radiance[size_t(cubeTexelIndex(face, i, 15 - i, 16))].x ==
                  doctest::Approx(expected).epsilon(4e-3));
        }
}

TEST_CASE("light cube: one bright pixel keeps its energy, at any resolution and latitude") {
    for (int width : {64, 128, 256, 1024})
        for (int row : {0, 1, 3, width / 8, width / 4, width / 4 + width / 13, width / 2 - 1}) {
            Environment map = black(width);
            map.radiance[size_t(row * width + row * 37 % width)] = vec3(1000);
            const LightCube cube = sampleEnvironment(prepareForSampling(map, 256), 32, 0.4f);
            CHECK(irradianceSum(cube) == doctest::Approx(1000 * pixelSolidAngle(map, row)).epsilon(0.012));
        }
}

TEST_CASE("light cube: a positive rotation turns +Z towards +X") {
    Environment map = black(64);
    // A bright spot in the middle of the map, along +Z.
    for (int y = 15; y <= 16; y++)
        for (int x = 31; x <= 32; x++) map.radiance[size_t(y * 64 + x)] = vec3(1);
    const Environment prepared = prepareForSampling(map);
    CHECK(radianceTowards(sampleEnvironment(prepared, 16, 0), {0, 0, 1}).x > 0.5f);
    CHECK(radianceTowards(sampleEnvironment(prepared, 16, kPi / 2), {1, 0, 0}).x > 0.5f);
    CHECK(radianceTowards(sampleEnvironment(prepared, 16, kPi / 4), glm::vec3(1, 0.01f, 1)).x > 0.5f);
    CHECK(radianceTowards(sampleEnvironment(prepared, 16, -kPi / 2), {-1, 0, 0}).x > 0.5f);
}

TEST_CASE("light cube: samples are finer than a quarter of a pixel, and never fewer than two") {
    CHECK(samplesPerTexelSide(2, 64) == 2);
    CHECK(samplesPerTexelSide(512, 64) == 13);
    CHECK(samplesPerTexelSide(512, 32) == 26);
}

TEST_CASE("light footprints: on every face they sum what bilinear lookups do, row by row") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform;
    for (int width : {10, 64}) { // 64: faces are made from one another
        Environment map = black(width);
        for (vec3& pixel : map.radiance) pixel = vec3(uniform(random));
        const LightFootprints footprints = makeLightFootprints(map.width, map.height, 8);
        const int count = samplesPerTexelSide(width, 8);
        for (int texel = 0; texel < kCubeFaces * 64; texel++) {
            float found = 0, expected = 0, weights = 0;
            uint32_t before = 0;
            for (uint32_t i = footprints.starts[size_t(texel)]; i < footprints.starts[size_t(texel) + 1];
                 i++) {
                const auto [place, weight] = footprints.pixels[i];
                found += weight * map.radiance[size_t(place >> 16) * size_t(width) + (place & 0xffff)].x;
                CHECK(place >= before);
                before = place + 1;
            }
            forEachSubCell(texel / 64, texel % 8, texel / 8 % 8, 8, count, [&](vec3 direction, float weight) {
                expected += weight * map.lookup(direction).x;
                weights += weight;
            });
            CHECK(found == doctest::Approx(expected / weights).epsilon(1e-4));
        }
    }
}

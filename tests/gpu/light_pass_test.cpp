#include "engine/math/cubemap.h"
#include "engine/render/light_pass.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <map>
#include <random>

using namespace relume;

namespace {

// Smooth, with a small bright sun, brighter than all the rest by far.
Environment makeTestEnvironment(int width) {
    Environment map{width, width / 2, {}};
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            const vec3 d = map.direction(float(x) + 0.5f, float(y) + 0.5f);
            const float sun = glm::dot(d, glm::normalize(vec3(0.3f, 0.5f, -0.8f))) > 0.995f ? 50.0f : 0.0f;
            map.radiance.push_back(vec3(1.0f + d.x, 1.2f + d.y, 1.5f + d.z) + sun);
        }
    return prepareForSampling(map);
}

LightCube makeNoise(int size, float low, float high) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(low, high);
    LightCube cube{size, {}};
    for (int i = 0; i < 6 * size * size; i++)
        cube.radiance.emplace_back(value(random), value(random), value(random));
    return cube;
}

void submit(const vk::Device& device, LightPass& pass, float rotation, const LightSelection& selection) {
    vk::Commands commands(device, "light test");
    commands.begin();
    pass.record(commands, rotation, selection);
    commands.submitAndWait();
}

std::map<int, std::array<int, 3>> entriesOf(const LightVector& vector) {
    std::map<int, std::array<int, 3>> entries;
    for (size_t e = 0; e < vector.indices.size(); e++)
        entries[vector.indices[e]] = {vector.values[e][0], vector.values[e][1], vector.values[e][2]};
    return entries;
}

// Of cubes that differ by rounding: the same scale, and the same values within a step. An entry may be on one
// side only if it is within a step of where it is dropped.
void checkSameVector(const LightVector& device, const LightVector& host, int threshold) {
    CHECK_EQ(device.faceSize, host.faceSize);
    CHECK_EQ(device.scale, host.scale);
    auto left = entriesOf(device), right = entriesOf(host);
    int worst = 0, lonely = 0;
    for (const auto& [index, value] : left) {
        if (!right.contains(index)) {
            lonely++;
            continue;
        }
        for (size_t c = 0; c < 3; c++) worst = std::max(worst, std::abs(value[c] - right[index][c]));
    }
    for (const auto& [index, value] : right) lonely += !left.contains(index);
    CHECK_LE(worst, 1);
    CHECK_LE(lonely, int(right.size()) / 1000 + (threshold > 1 ? 1 : 0));
}

// Of one cube: the same in every bit.
void checkSameBits(const LightVector& device, const LightVector& host) {
    CHECK_EQ(device.scale, host.scale);
    CHECK_EQ(device.error, doctest::Approx(host.error).epsilon(1e-4));
    CHECK(device.indices == host.indices);
    CHECK(device.values == host.values);
}

} // namespace

TEST_CASE("light pass: a constant environment is one coefficient a face") {
    const TestDevice device;
    LightPass pass(device, 64);
    pass.setEnvironment({16, 8, std::vector<vec3>(128, vec3(3, 2, 1))});
    submit(device, pass, 0.7f, {});
    for (const vec3& radiance : pass.readCube().radiance)
        for (int c = 0; c < 3; c++) CHECK_EQ(radiance[c], doctest::Approx(3 - c).epsilon(1e-5));
    const LightVector vector = pass.readVector();
    REQUIRE_EQ(vector.indices.size(), 6);
    for (size_t face = 0; face < 6; face++) {
        CHECK_EQ(vector.indices[face], face * 4096);
        CHECK_LE(std::abs(vector.values[face][0] - 24576), 1);
        CHECK_LE(std::abs(vector.values[face][1] - 16384), 1);
    }
    CHECK_EQ(vector.scale, 128.0f / 16384);
}

TEST_CASE("light pass: an environment agrees with the CPU twin") {
    const TestDevice device;
    for (const int faceSize : {32, 64})
        for (const int width : {64, 512}) {
            const Environment environment = makeTestEnvironment(width);
            LightPass pass(device, faceSize);
            pass.setEnvironment(environment);
            for (const float rotation : {0.0f, 2.5f}) {
                submit(device, pass, rotation, {kPaperLightThreshold});
                const LightCube cube = pass.readCube(),
                                expected = sampleEnvironment(environment, faceSize, rotation);
                float worst = 0;
                for (size_t i = 0; i < cube.radiance.size(); i++)
                    for (int c = 0; c < 3; c++)
                        worst = std::max(worst, std::abs(cube.radiance[i][c] - expected.radiance[i][c]) /
                                                    expected.radiance[i][c]);
                CHECK_LT(worst, 1e-4f);
                checkSameVector(pass.readVector(), makeLightVector(expected, {kPaperLightThreshold}),
                                kPaperLightThreshold);
            }
        }
}

TEST_CASE("light pass: a cube is quantized as by the CPU twin") {
    const TestDevice device;
    LightPass pass(device, 64);
    for (const int threshold : {0, 1, 300, 1024}) {
        const LightCube cube = sampleLight({.distant = {{{0.2f, 0.9f, 0.4f}, {3, 2, 1}}}}, 64);
        pass.setCube(cube);
        submit(device, pass, 0, {threshold});
        checkSameBits(pass.readVector(), makeLightVector(cube, {threshold}));
    }
}

TEST_CASE("light pass: the range guard coarsens as the CPU twin does") {
    const TestDevice device;
    for (const int faceSize : {32, 64}) {
        LightPass pass(device, faceSize);
        const LightCube cube = makeNoise(faceSize, -1, 1); // negative radiance: the largest sums there are
        pass.setCube(cube);
        submit(device, pass, 0, {0});
        const LightVector vector = pass.readVector();
        uint64_t sum = 0;
        int largest = 0;
        for (const auto& value : vector.values) {
            sum += uint64_t(std::abs(value[0]));
            for (int c : value) largest = std::max(largest, std::abs(c));
        }
        CHECK_LT(largest, kLightMaximum / 4); // three halvings, at least
        CHECK_LE(sum, kLightSumLimit);
        checkSameBits(vector, makeLightVector(cube, {0}));
    }
}

TEST_CASE("light pass: any cube is quantized to the CPU twin's bits, however bright") {
    const TestDevice device;
    LightPass pass(device, 32);
    std::mt19937 random(11);
    for (const float brightness : {1.0f, 3.7e-4f, 0x1p-70f, 0x1p-86f, 0x1p-128f, 1e30f, 0x1p120f}) {
        // Exponentially many dark texels for few bright ones, as photographs have them.
        std::normal_distribution<float> logarithm(-2, 2);
        LightCube cube{32, {}};
        for (int i = 0; i < 6 * 32 * 32; i++)
            cube.radiance.push_back(vec3(1, 0.8f, 0.6f) *
                                    (brightness * std::min(std::exp(logarithm(random)), 64.0f) / 64));
        pass.setCube(cube);
        for (const int threshold : {0, 20, 1024}) {
            CAPTURE(brightness);
            CAPTURE(threshold);
            submit(device, pass, 0, {threshold});
            checkSameBits(pass.readVector(), makeLightVector(cube, {threshold}));
        }
    }
}

TEST_CASE("light pass: all sources together agree with the CPU twin") {
    const TestDevice device;
    const auto map = [](int width) {
        return std::make_shared<const Environment>(makeTestEnvironment(width));
    };
    std::mt19937 random(17);
    std::uniform_real_distribution<float> coordinate(-1, 1);
    const auto direction = [&] { return vec3(coordinate(random), coordinate(random), coordinate(random)); };
    Light light{.environments = {{map(64), 0.3f, 0.7f}, {map(128), 1, 0.3f}, {map(64), 2, 0.1f}}};
    light.strokes = {{{0, 1, 0.2f}, 0.5f, {3, 0, 0}, 0, 1}, {{0, 1, 0.4f}, 0.2f, {0, 2, 0}, 1, 0.5f}};
    light.lamps = {
        {{1, 1, 1}, 1e-4f, vec3(1e7f)}, {{-1, 0.1f, 0}, 1.2f, {0, 0, 4}}, {{0, -1, 0}, kPi, vec3(0.1f)}};
    // More than one dispatch looks at, small ones on one texel, whose loops are the longest.
    for (int i = 0; i < 130; i++) light.lamps.push_back({{1, 0.01f, 0.015f}, 0.004f, {1, float(i), 2}});
    for (int i = 0; i < 130; i++) light.strokes.push_back({direction(), 0.02f, vec3(float(i)), 0.3f, 0.8f});
    for (int i = 0; i < 300; i++) light.distant.push_back({direction(), vec3(coordinate(random) + 1)});
    for (const int faceSize : {2, 32, 64}) {
        LightPass pass(device, faceSize);
        pass.setLight(light);
        for (const float rotation : {0.0f, 1.3f}) {
            submit(device, pass, rotation, {});
            const LightCube cube = pass.readCube(), expected = sampleLight(turned(light, rotation), faceSize);
            float worst = 0;
            for (size_t i = 0; i < cube.radiance.size(); i++)
                for (int c = 0; c < 3; c++)
                    worst = std::max(worst, std::abs(cube.radiance[i][c] - expected.radiance[i][c]) /
                                                (1 + expected.radiance[i][c]));
            CAPTURE(faceSize);
            CHECK_LT(worst, 2e-4f);
        }
    }
}

TEST_CASE("light pass: the day sky agrees with the CPU twin") {
    const TestDevice device;
    for (const int faceSize : {32, 64}) {
        LightPass pass(device, faceSize);
        for (const float elevation : {70.0f, 8.0f, 0.1f, -4.0f})
            for (const float turbidity : {2.0f, 6.0f}) {
                const Light light{.sky = DaySky{.sun = directionAt(130, elevation), .turbidity = turbidity}};
                pass.setLight(light);
                submit(device, pass, 0, {});
                const LightCube cube = pass.readCube(), expected = sampleLight(light, faceSize);
                float worst = 0, largest = 0;
                for (size_t i = 0; i < cube.radiance.size(); i++)
                    for (int c = 0; c < 3; c++) {
                        largest = std::max(largest, expected.radiance[i][c]);
                        worst = std::max(worst, std::abs(cube.radiance[i][c] - expected.radiance[i][c]) /
                                                    (1e-9f + expected.radiance[i].y));
                    }
                CAPTURE(elevation);
                CAPTURE(turbidity);
                CHECK_LT(worst, 2e-3f);
                CHECK_GT(largest, 0);
            }
    }
}

TEST_CASE("light pass: a light after another leaves nothing of it") {
    const TestDevice device;
    LightPass pass(device, 32);
    const auto map = std::make_shared<const Environment>(makeTestEnvironment(64));
    const Light first{.environments = {{map, 0, 1}}, .lamps = {{{1, 0, 0}, 0.3f, vec3(5)}}};
    const Light second{.environments = {{map, 1, 2}}}, third{.distant = {{{0, 1, 0}, vec3(1)}}};
    for (const Light& light : {first, second, third, first}) {
        pass.setLight(light);
        submit(device, pass, 0, {});
        const LightCube cube = pass.readCube(), expected = sampleLight(light, 32);
        float worst = 0;
        for (size_t i = 0; i < cube.radiance.size(); i++)
            worst = std::max(worst, glm::distance(cube.radiance[i], expected.radiance[i]));
        CHECK_LT(worst, 0.05f); // of a distant light of 1 in a texel or four: up to 300
    }
}

TEST_CASE("light pass: every selection keeps what the CPU twin keeps") {
    const TestDevice device;
    for (const int faceSize : {2, 32, 64}) {
        LightPass pass(device, faceSize);
        std::mt19937 random(13);
        LightCube cube{faceSize, {}};
        for (int i = 0; i < 6 * faceSize * faceSize; i++) // few values: many equals
            cube.radiance.push_back(vec3(float(random() % 4), float(random() % 3), float(random() % 2)));
        pass.setCube(cube);
        const int all = int(cube.radiance.size());
        for (const bool areaWeighted : {false, true})
            for (const LightSelection& selection : std::initializer_list<LightSelection>{{.threshold = 0},
                                                                                         {.threshold = 500},
                                                                                         {.count = 1},
                                                                                         {.count = 7},
                                                                                         {.count = all / 3},
                                                                                         {.count = all - 1},
                                                                                         {.count = 24576}}) {
                LightSelection weighted = selection;
                weighted.areaWeighted = areaWeighted;
                CAPTURE(faceSize);
                CAPTURE(areaWeighted);
                CAPTURE(selection.threshold.value_or(-selection.count));
                submit(device, pass, 0, weighted);
                const LightVector vector = pass.readVector();
                checkSameBits(vector, makeLightVector(cube, weighted));
                CHECK_EQ(pass.readStats().kept, vector.indices.size());
                CHECK_EQ(pass.readStats().error, vector.error);
            }
    }
}

TEST_CASE("light pass: the step turns where the largest coefficient passes 32767 of it") {
    const TestDevice device;
    LightPass pass(device, 2);
    for (const float largest : {32767.0f, std::nextafter(32767.0f, 1e9f), 32768.0f}) {
        LightCube cube{2, std::vector<vec3>(6 * 4, vec3(0))};
        std::fill_n(cube.radiance.begin(), 4, vec3(largest / 2)); // whose average is half the sum
        pass.setCube(cube);
        submit(device, pass, 0, {});
        CHECK_EQ(pass.readVector().scale, largest > 32767 ? 2 : 1);
        checkSameBits(pass.readVector(), makeLightVector(cube));
    }
}

TEST_CASE("light pass: no light is no coefficient") {
    const TestDevice device;
    LightPass pass(device, 32);
    pass.setCube({32, std::vector<vec3>(6 * 32 * 32, vec3(0))});
    submit(device, pass, 0, {0});
    const LightVector vector = pass.readVector();
    CHECK_EQ(vector.scale, 0);
    CHECK(vector.indices.empty());
}

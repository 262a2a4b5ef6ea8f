// Tests that the background shows the light that illuminates the object.
#include "engine/light/background.h"
#include "engine/math/cubemap.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

vec3 smooth(vec3 d) { return {1 + d.x, 2 + d.y * d.z, 1.5f - 0.5f * d.z}; }

Environment mapOf(int width, vec3 (*radiance)(vec3)) {
    Environment map{width, width / 2, {}};
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++)
            map.radiance.push_back(radiance(map.direction(float(x) + 0.5f, float(y) + 0.5f)));
    return map;
}

EnvironmentLight lightOf(Environment map, float rotation = 0, float gain = 1) {
    EnvironmentLight light{std::make_shared<const Environment>(prepareForSampling(map)), rotation, gain};
    light.picture = makePicture(std::move(map));
    return light;
}

double solidAngle(const Environment& map, int row) {
    const double step = M_PI / map.height;
    return 2 * M_PI / map.width * 2 * std::sin(step / 2) * std::sin(step * (row + 0.5));
}

glm::dvec3 energyOf(const Environment& map) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < map.radiance.size(); i++)
        sum += solidAngle(map, int(i) / map.width) * glm::dvec3(map.radiance[i]);
    return sum;
}

// How far the background is from the lighting cube that LightPass's twin makes, at texels, relative to the
// mean.
double distanceToCube(const Light& light, float turn, float deviation = 0) {
    const LightCube cube = sampleLight(turned(light, turn), 32);
    const Background background = makeBackground(turned(light, turn), deviation);
    double sum = 0, worst = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < 32; y++)
            for (int x = 0; x < 32; x++) {
                const vec3 lit = cube.radiance[size_t(cubeTexelIndex(face, x, y, 32))];
                const vec3 seen = background.radiance(cubeTexelDirection(face, x, y, 32), 2.0f / 32);
                sum += double(lit.x + lit.y + lit.z);
                const vec3 d = glm::abs(seen - lit);
                worst = std::max(worst, double(std::max(d.x, std::max(d.y, d.z))));
            }
    return worst / (sum / (3 * 6 * 32 * 32));
}

} // namespace

TEST_CASE("background: is the light that the cube holds, turned as it is turned") {
    Light light{.environments = {lightOf(mapOf(256, smooth), 0.7f, 1.5f)}};
    for (const float turn : {0.0f, 1.3f, -2.0f})
        CHECK_LT(distanceToCube(light, turn), 0.03); // poles are level
    light.environments.push_back(
        lightOf(mapOf(128, [](vec3 d) { return vec3(2 + d.z, 1 - d.x, 1); }), -0.4f, 0.5f));
    CHECK_LT(distanceToCube(light, 0.9f), 0.03);
    light.strokes = {
        {.direction = {1, 1, 0}, .angularRadius = 0.9f, .radiance = vec3(3, 1, 0), .softness = 1},
        {.direction = {1, 0, 0.5f}, .angularRadius = 0.6f, .radiance = vec3(0, 1, 0), .softness = 1}};
    CHECK_LT(distanceToCube(light, 0.9f), 0.08); // texels are wide
    light.sky = DaySky{.sun = glm::normalize(vec3(0.3f, 0.8f, -0.5f)), .hasDisc = false};
    CHECK_LT(distanceToCube(light, 0.9f), 0.08);
    // Hardly out of focus it is about the same, and all of it in one map.
    CHECK_LT(distanceToCube(light, 0.9f, 0.01f), 0.15);
    CHECK_FALSE(makeBackground(light, 0.01f).sky);
}

TEST_CASE("background: the sun is seen where it stands, lamps and distant lights are not") {
    Light light{
        .environments = {}, .lamps = {{vec3(0, 1, 0), 0.5f, vec3(7)}}, .distant = {{vec3(0, 0, 1), vec3(5)}}};
    CHECK_EQ(makeBackground(light).radiance({0, 1, 0}, 1e-3f), vec3(0));
    light.sky = DaySky{.sun = glm::normalize(vec3(1, 1, 0)), .ground = vec3(0)}; // which the sun lights
    const Background background = makeBackground(light);
    const vec3 sun = sunLamp(*light.sky).radiance;
    const vec3 beside = glm::normalize(vec3(1, 1.02f, 0));
    CHECK_GT(background.radiance(light.sky->sun, 1e-4f).x, 0.99f * sun.x);
    CHECK_LT(background.radiance(beside, 1e-4f).x, 1e-3f * sun.x);
    // Blurred, its light is kept, sky's horizon and all.
    const Environment blurred = *makeBackground(light, 0.05f).map;
    light.sky->hasDisc = false;
    const Environment bare = *makeBackground(light, 0.05f).map;
    const glm::dvec3 energy = energyOf(blurred) - energyOf(bare);
    CHECK(energy.x == doctest::Approx(double(sun.x) * M_PI * std::pow(0.265 * M_PI / 180, 2)).epsilon(0.02));
}

TEST_CASE("background: a map that was made is not made again") {
    Light light{.environments = {lightOf(mapOf(64, smooth)), lightOf(mapOf(64, smooth), 1)}};
    const Background first = makeBackground(light);
    CHECK_EQ(makeBackground(light, 0, first).map, first.map);
    CHECK_EQ(makeBackground(turned(light, 0.5f), 0, first).rotation, 0.5f);
    light.environments[1].gain = 0.5f;
    CHECK_NE(makeBackground(light, 0, first).map, first.map);
    const Background blurred = makeBackground(light, 0.1f, first);
    CHECK_NE(blurred.map, first.map);
    CHECK_EQ(makeBackground(light, 0.1f, blurred).map, blurred.map);
    CHECK_NE(makeBackground(light, 0.2f, blurred).map, blurred.map);
    light.strokes.push_back({.direction = {1, 0, 0}, .angularRadius = 1, .radiance = vec3(1)});
    CHECK_NE(makeBackground(light, 0.1f, blurred).map, blurred.map);
}

TEST_CASE("background: blur keeps energy and even maps, and spreads as far as it says") {
    const Environment even = blur(mapOf(48, [](vec3) { return vec3(1, 2, 3); }), 0.3f);
    for (const vec3& radiance : even.radiance) {
        CHECK(radiance.x == doctest::Approx(1).epsilon(1e-5));
        CHECK(radiance.z == doctest::Approx(3).epsilon(1e-5));
    }
    std::mt19937 random(3);
    Environment rough{96, 48, {}};
    for (int i = 0; i < 96 * 48; i++)
        rough.radiance.emplace_back(random() % 100, i % 7, random() % 5000 == 0 ? 1e5f : 0);
    for (const float deviation : {0.0f, 0.02f, 0.2f, 1.5f}) {
        const glm::dvec3 before = energyOf(rough), after = energyOf(blur(rough, deviation));
        for (int c = 0; c < 3; c++) CHECK(after[c] == doctest::Approx(before[c]).epsilon(1e-5));
    }
    // A point, wherever it is: half the mean squared distance is the variance along an axis.
    for (const int row : {0, 5, 40, 64, 127}) {
        Environment point{256, 128, std::vector<vec3>(256 * 128, vec3(0))};
        point.radiance[size_t(row) * 256 + 17] = vec3(1);
        const vec3 middle = point.direction(17.5f, float(row) + 0.5f);
        const Environment spread = blur(point, 0.12f);
        double sum = 0, weights = 0;
        for (int y = 0; y < 128; y++)
            for (int x = 0; x < 256; x++) {
                const vec3 d = spread.direction(float(x) + 0.5f, float(y) + 0.5f);
                const double weight =
                    solidAngle(spread, y) * double(spread.radiance[size_t(y) * 256 + size_t(x)].x);
                sum += weight * std::pow(2 * std::asin(0.5 * double(glm::distance(d, middle))), 2);
                weights += weight;
            }
        CAPTURE(row);
        CHECK(std::sqrt(sum / weights / 2) == doctest::Approx(0.12).epsilon(0.05));
    }
}

TEST_CASE("background: is drawn behind what the image shows, where the camera looks") {
    const Background background = makeBackground({.environments = {lightOf(mapOf(512, smooth))}});
    const Camera camera{vec3(1, 2, 3), vec3(-1, 0.5f, 0.2f), 0.8f};
    Image image(24, 16);
    image.at(3, 4) = vec4(5, 6, 7, 1);
    image.at(4, 4) = vec4(0.5f, 0.25f, 0, 0.25f);
    drawBackground(image, background, camera, 0.6f);
    CHECK_EQ(image.at(3, 4), vec4(5, 6, 7, 1));
    const auto expected = [&](int x, int y) {
        const vec3 d = camera.pixelDirection(x, y, 24, 16); // what is seen there was turned there
        return smooth(
            {std::cos(0.6f) * d.x - std::sin(0.6f) * d.z, d.y, std::sin(0.6f) * d.x + std::cos(0.6f) * d.z});
    };
    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 24; x++) {
            if (y == 4 && x == 3) continue;
            const bool isHalf = y == 4 && x == 4;
            const vec3 right = isHalf ? vec3(0.5f, 0.25f, 0) + 0.75f * expected(x, y) : expected(x, y);
            CHECK_LT(glm::distance(vec3(image.at(x, y)), right), 0.005f);
            CHECK_EQ(image.at(x, y).w, 1);
        }
}

#include "engine/light/cap.h"
#include "engine/light/light.h"
#include "engine/math/cubemap.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

// In units of kcd/m² or klx.
float luminance(vec3 rgb) { return glm::dot(rgb, vec3(0.2126f, 0.7152f, 0.0722f)) * 100 / kPi; }

DaySky skyAt(float elevation, float turbidity = 3) {
    return {.sun = directionAt(0, elevation), .turbidity = turbidity};
}

float zenithLuminance(const DaySky& sky) { return luminance(skyRadiance(makeSkyModel(sky), {0, 1, 0})); }

float sunIlluminance(const DaySky& sky) {
    const Lamp sun = sunLamp(sky);
    return luminance(sun.radiance) * capSolidAngle(sun.angularRadius);
}

} // namespace

TEST_CASE("day sky: the zenith has the paper's luminance") {
    // Yz = (4.0453 T - 4.9710) tan((4/9 - T/120) (π - 2θ)) - 0.2155 T + 2.4192, by hand.
    CHECK(zenithLuminance(skyAt(45, 3)) == doctest::Approx(7.325).epsilon(2e-3));
    CHECK(zenithLuminance(skyAt(30, 6)) == doctest::Approx(9.584).epsilon(2e-3));
    CHECK(zenithLuminance(skyAt(0, 2)) == doctest::Approx(1.988).epsilon(5e-3));
}

TEST_CASE("day sky: blue above, bright around the sun, and the ground reflects") {
    const DaySky sky = skyAt(40);
    const shared::LightSky model = makeSkyModel(sky);
    const vec3 away = skyRadiance(model, directionAt(180, 60));
    CHECK(away.z > 1.5f * away.x);
    CHECK(luminance(skyRadiance(model, directionAt(5, 42))) > 3 * luminance(away));
    CHECK(skyRadiance(model, {0, -1, 0}) == skyRadiance(model, glm::normalize(vec3(1, -0.01f, 0))));
    // Horizontal irradiance, from the lit cube: the ground is a fifth of it over π.
    const LightCube cube = sampleLight({.sky = sky}, 64);
    double irradiance = 0;
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++)
                irradiance += double(cube.radiance[size_t(cubeTexelIndex(face, x, y, 64))].y) *
                              double(std::max(cubeTexelDirection(face, x, y, 64).y, 0.0f)) *
                              double(cubeTexelSolidAngle(x, y, 64));
    CHECK(model.ground.y == doctest::Approx(0.2 * irradiance / double(kPi)).epsilon(0.01));
}

TEST_CASE("day sky: a high sun gives what is measured, a low one reddens, and it sets smoothly") {
    // A clear noon: 80 to 105 klx from the sun alone.
    CHECK(sunIlluminance(skyAt(60, 2.5f)) > 80);
    CHECK(sunIlluminance(skyAt(60, 2.5f)) < 105);
    const vec3 low = sunLamp(skyAt(3)).radiance;
    CHECK(low.x > 2 * low.y);
    CHECK(low.y > 2 * low.z);
    CHECK(sunIlluminance(skyAt(0)) < 0.6f * sunIlluminance(skyAt(0.3f)));
    CHECK(sunIlluminance(skyAt(-0.3f)) == 0);
    float last = zenithLuminance(skyAt(1));
    for (float elevation = 0.9f; elevation > -12; elevation -= 0.1f) {
        const float next = zenithLuminance(skyAt(elevation));
        CHECK(next < last);
        CHECK(next > 0.9f * last);
        last = next;
    }
    CHECK(zenithLuminance(skyAt(-6)) == doctest::Approx(zenithLuminance(skyAt(0)) / 117).epsilon(0.02));
    CHECK(sampleLight({.sky = DaySky{.sun = {0, -1, 0}}}, 16).radiance[0].x < 1e-20f);
}

TEST_CASE("day sky: turning and scaling do what they say, without a disc there is none") {
    const Light light{.sky = skyAt(30)};
    const LightCube once = sampleLight(light, 16), quarter = sampleLight(turned(light, kPi / 2), 16),
                    bright = sampleLight(scaled(light, 3), 16);
    float largest = 0;
    for (size_t i = 0; i < 256; i++) {
        CHECK(glm::distance(quarter.radiance[i], once.radiance[4 * 256 + i]) <
              0.01f * (1 + glm::length(quarter.radiance[i])));
        CHECK(glm::distance(bright.radiance[i], 3.0f * once.radiance[i]) < 1e-3f);
        largest = std::max(largest, once.radiance[4 * 256 + i].y);
    }
    CHECK(largest > 10);
    DaySky dull = skyAt(30);
    dull.hasDisc = false;
    for (const vec3& radiance : sampleLight({.sky = dull}, 16).radiance) CHECK(radiance.y < 1);
}

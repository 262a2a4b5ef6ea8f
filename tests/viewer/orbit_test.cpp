// The camera as a hand moves it: what is grabbed stays under the hand.
#include "apps/viewer/orbit.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr ivec2 kOrbitSize(640, 480);
constexpr float kAspect = 4.0f / 3;

Orbit sample() { return {{0.3f, -0.2f, 1}, 0.7f, 0.4f, 3, 0.8f}; }

// Where the ray through a pixel meets the plane through the target that faces the eye.
vec3 onTargetPlane(const Camera& camera, ivec2 pixel) {
    const vec3 forward = glm::normalize(camera.target - camera.eye),
               ray = camera.pixelDirection(pixel.x, pixel.y, kOrbitSize.x, kOrbitSize.y);
    return camera.eye + glm::distance(camera.target, camera.eye) / glm::dot(ray, forward) * ray;
}

} // namespace

TEST_CASE("orbit: a point is seen where its pixel's ray goes") {
    const Camera camera = sample().camera();
    CHECK(glm::distance(camera.eye, camera.target) == doctest::Approx(3));
    for (const ivec2 pixel : {ivec2(0, 0), ivec2(320, 240), ivec2(639, 10), ivec2(100, 479)})
        for (const float away : {0.1f, 2.0f, 50.0f}) {
            const vec3 point =
                camera.eye + away * camera.pixelDirection(pixel.x, pixel.y, kOrbitSize.x, kOrbitSize.y);
            const auto place = pixelOf(point, camera, kOrbitSize);
            REQUIRE(place);
            CHECK(glm::distance(*place, vec2(pixel) + 0.5f) < 0.02f);
        }
    CHECK_FALSE(pixelOf(camera.eye + (camera.eye - camera.target), camera, kOrbitSize));
    CHECK_FALSE(pixelOf(camera.eye, camera, kOrbitSize));
}

TEST_CASE("orbit: moved, the target follows the hand") {
    Orbit orbit = sample();
    const vec3 grabbed = orbit.target;
    orbit.pan({40, -25}, float(kOrbitSize.y));
    const auto place = pixelOf(grabbed, orbit.camera(), kOrbitSize);
    REQUIRE(place);
    CHECK(glm::distance(*place, vec2(320 + 40, 240 - 25)) < 0.05f);
    CHECK_EQ(orbit.distance, sample().distance);
}

TEST_CASE("orbit: turned, the eye goes around and never over the top") {
    Orbit orbit = sample();
    orbit.turn({48, 0}, 480);
    CHECK(orbit.azimuth == doctest::Approx(0.7 - 0.3));
    CHECK_EQ(orbit.target, sample().target);
    orbit.turn({0, 1e5f}, 480);
    CHECK(glm::degrees(orbit.elevation) == doctest::Approx(89.5));
    CHECK(std::isfinite(orbit.camera().pixelDirection(0, 0, 4, 3).x));
    orbit.turn({0, -1e5f}, 480);
    CHECK(glm::degrees(orbit.elevation) == doctest::Approx(-89.5));
    orbit.turn({-1e4f, 0}, 480);
    CHECK_LE(std::abs(orbit.azimuth), kPi + 1e-5f);
}

TEST_CASE("orbit: nearer or farther, what is under the cursor stays there") {
    for (const ivec2 pixel : {ivec2(320, 240), ivec2(50, 400), ivec2(600, 30)})
        for (const float steps : {3.0f, -2.0f}) {
            Orbit orbit = sample();
            const vec3 point = onTargetPlane(orbit.camera(), pixel);
            const vec2 cursor = 2.0f * (vec2(pixel) + 0.5f) / vec2(kOrbitSize) - 1.0f;
            orbit.zoom(steps, cursor, kAspect, 1);
            CHECK((orbit.distance < 3) == (steps > 0));
            const auto place = pixelOf(point, orbit.camera(), kOrbitSize);
            REQUIRE(place);
            CHECK(glm::distance(*place, vec2(pixel) + 0.5f) < 0.05f);
        }
    Orbit orbit = sample();
    orbit.zoom(1e4f, {0, 0}, kAspect, 2);
    CHECK(orbit.distance == doctest::Approx(2e-3));
    orbit.zoom(-1e4f, {0, 0}, kAspect, 2);
    CHECK(orbit.distance == doctest::Approx(2e3));
}

TEST_CASE("orbit: the default is the default camera's") {
    const Bounds bounds{{-1, 0, -2}, {3, 1, 2}};
    const Camera expected = defaultCamera(bounds, 0.6f, kAspect),
                 camera = defaultOrbit(bounds, 0.6f, kAspect).camera();
    CHECK(glm::distance(camera.eye, expected.eye) < 1e-4f);
    CHECK_EQ(camera.target, expected.target);
    CHECK_EQ(camera.verticalFov, expected.verticalFov);
}

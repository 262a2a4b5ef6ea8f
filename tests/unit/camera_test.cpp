#include "engine/scene/camera.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace relume;

namespace {

Bounds box(vec3 low, vec3 high) {
    Bounds bounds;
    bounds.add(low);
    bounds.add(high);
    return bounds;
}

vec3 project(const mat4& clip, vec3 point) {
    const vec4 p = clip * vec4(point, 1);
    return vec3(p) / p.w;
}

} // namespace

TEST_CASE("camera: what lies along a pixel's direction projects to that pixel's center") {
    const Bounds bounds = box({-1, -2, -3}, {4, 3, 2});
    const int width = 64, height = 36;
    const float aspect = float(width) / float(height);
    for (const Camera& camera : {orbitCamera(bounds, 0.5f, 0.3f, 1.5f, 0.6f, aspect),
                                 Camera{{3, 7, 1}, {3, -1, 1}, 0.9f}, Camera{{9, 1, -4}, {0, 0, 0}, 1.2f}}) {
        const mat4 clip = camera.clipFromWorld(aspect, bounds);
        for (int y : {0, 11, 35})
            for (int x : {0, 20, 63}) {
                const vec3 direction = camera.pixelDirection(x, y, width, height);
                CHECK(glm::length(direction) == doctest::Approx(1));
                const vec3 seen = project(clip, camera.eye + 5.0f * direction);
                CHECK((0.5f * seen.x + 0.5f) * float(width) ==
                      doctest::Approx(float(x) + 0.5f).epsilon(1e-4));
                CHECK((0.5f * seen.y + 0.5f) * float(height) ==
                      doctest::Approx(float(y) + 0.5f).epsilon(1e-4));
            }
    }
}

TEST_CASE("camera: y runs down, x to the right, depth from 0 to 1 across the scene") {
    const Bounds bounds = box(vec3(-1), vec3(1));
    const Camera camera{{0, 0, 5}, vec3(0), 0.8f};
    const mat4 clip = camera.clipFromWorld(1, bounds);
    CHECK(project(clip, {0, 0.5f, 0}).y < -0.1f);
    CHECK(project(clip, {0.5f, 0, 0}).x > 0.1f);
    const float radius = bounds.radius();
    const float front = project(clip, {0, 0, radius}).z, back = project(clip, {0, 0, -radius}).z;
    CHECK(front > 0);
    CHECK(front < 0.05f);
    CHECK(back < 1);
    CHECK(back > 0.95f);
}

TEST_CASE("camera: orbits start at +Z and turn towards +X") {
    const Bounds bounds = box({1, 2, 3}, {3, 4, 5});
    const vec3 center = bounds.center();
    CHECK(glm::distance(glm::normalize(orbitCamera(bounds, 0, 0, 1, 0.6f, 1).eye - center), vec3(0, 0, 1)) <
          1e-6f);
    CHECK(orbitCamera(bounds, 0.3f, 0, 1, 0.6f, 1).eye.x > center.x);
    CHECK(orbitCamera(bounds, 0, 0.3f, 1, 0.6f, 1).eye.y > center.y);
    const Camera above = orbitCamera(bounds, 0.7f, kPi / 2, 1, 0.6f, 1);
    CHECK(std::isfinite(above.clipFromWorld(1, bounds)[0][0]));
}

TEST_CASE("camera: the bounding sphere just fits, in wide and in tall images") {
    const Bounds bounds = box({-2, 0, -1}, {2, 3, 1});
    for (float aspect : {0.5f, 1.0f, 16.0f / 9}) {
        const Camera fitted = orbitCamera(bounds, 1, 0.2f, 1, 0.6f, aspect);
        const float limit = std::atan(std::tan(0.3f) * std::min(1.0f, aspect));
        CHECK(bounds.radius() / glm::distance(fitted.eye, bounds.center()) ==
              doctest::Approx(std::sin(limit)));
        const Camera standard = defaultCamera(bounds, 0.6f, aspect);
        CHECK(standard.eye.y > bounds.center().y);
    }
}

TEST_CASE("camera: the default view is filled by the bounding box, and holds all of it") {
    for (const Bounds& bounds :
         {box({-2, 0, -1}, {2, 3, 1}), box({5, 5, 5}, {6, 15, 6}), box(vec3(0), vec3(1))})
        for (float aspect : {0.5f, 1.0f, 16.0f / 9}) {
            const mat4 clip = defaultCamera(bounds, 0.6f, aspect).clipFromWorld(aspect, bounds);
            float furthest = 0;
            for (int corner = 0; corner < 8; corner++) {
                const vec3 place =
                    glm::mix(bounds.low, bounds.high, vec3(corner & 1, corner >> 1 & 1, corner >> 2));
                const vec3 seen = glm::abs(project(clip, place));
                furthest = std::max({furthest, seen.x, seen.y});
            }
            CHECK(furthest == doctest::Approx(0.94f));
        }
}

#include "apps/viewer/orbit.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr float kSteepest = 1.5620697f; // 89.5 degrees in radians

// Axes of the view: towards the eye, and the image's right and up.
struct Axes {
    vec3 back, right, up;
};

Axes axesOf(const Orbit& orbit) {
    const float c = std::cos(orbit.elevation), s = std::sin(orbit.elevation);
    const vec3 back(std::sin(orbit.azimuth) * c, s, std::cos(orbit.azimuth) * c);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return {back, right, glm::cross(back, right)};
}

} // namespace

Camera Orbit::camera() const { return {target + distance * axesOf(*this).back, target, verticalFov}; }

void Orbit::turn(vec2 pixels, float height) {
    constexpr float kPerHeight = 3; // radians
    azimuth = std::remainder(azimuth - kPerHeight * pixels.x / height, 2 * kPi);
    elevation = std::clamp(elevation + kPerHeight * pixels.y / height, -kSteepest, kSteepest);
}

void Orbit::pan(vec2 pixels, float height) {
    const float perPixel = 2 * std::tan(0.5f * verticalFov) * distance / height;
    const Axes axes = axesOf(*this);
    target += perPixel * (pixels.y * axes.up - pixels.x * axes.right);
}

void Orbit::zoom(float steps, vec2 cursor, float aspect, float radius) {
    constexpr float kPerStep = 0.88f;
    const float before = distance;
    distance = std::clamp(distance * std::pow(kPerStep, steps), 1e-3f * radius, 1e3f * radius);
    const float moved = (before - distance) * std::tan(0.5f * verticalFov);
    const Axes axes = axesOf(*this);
    target += moved * (cursor.x * aspect * axes.right - cursor.y * axes.up);
}

std::optional<vec2> pixelOf(vec3 point, const Camera& camera, ivec2 size) {
    const vec3 forward = glm::normalize(camera.target - camera.eye);
    const vec3 right = glm::normalize(glm::cross(forward, vec3(0, 1, 0)));
    const vec3 up = glm::cross(right, forward), arm = point - camera.eye;
    const float depth = glm::dot(arm, forward);
    if (depth <= 0) return std::nullopt;
    const float perUnit = 0.5f * float(size.y) / (std::tan(0.5f * camera.verticalFov) * depth);
    return 0.5f * vec2(size) + perUnit * vec2(glm::dot(arm, right), -glm::dot(arm, up));
}

Orbit orbitOf(const Camera& camera) {
    const vec3 arm = camera.eye - camera.target;
    const float distance = glm::length(arm);
    return {camera.target, std::atan2(arm.x, arm.z), std::asin(arm.y / distance), distance,
            camera.verticalFov};
}

Orbit defaultOrbit(const Bounds& bounds, float verticalFov, float aspect) {
    return orbitOf(defaultCamera(bounds, verticalFov, aspect));
}

} // namespace relume

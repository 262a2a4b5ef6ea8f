#include "engine/scene/camera.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

struct View {
    vec3 right, up, forward;
};

View viewOf(const Camera& camera) {
    const vec3 forward = glm::normalize(camera.target - camera.eye);
    // If the camera looks straight up or down, use ±Z as the up vector.
    const vec3 above = std::abs(forward.y) < 0.99999f ? vec3(0, 1, 0) : vec3(0, 0, forward.y);
    const vec3 right = glm::normalize(glm::cross(forward, above));
    return {right, glm::cross(right, forward), forward};
}

} // namespace

mat4 Camera::clipFromWorld(float aspect, const Bounds& scene) const {
    const View view = viewOf(*this);
    const float depth = glm::dot(scene.center() - eye, view.forward), radius = scene.radius();
    const float far = std::max(1.01f * (depth + radius), 1e-3f * radius);
    const float near = std::max(0.99f * (depth - radius), 1e-3f * far);
    const float yScale = 1 / std::tan(0.5f * verticalFov), xScale = yScale / aspect;
    const float zScale = far / (far - near);
    const auto row = [&](vec3 axis, float offset) { return vec4(axis, offset - glm::dot(axis, eye)); };
    return glm::transpose(mat4(row(xScale * view.right, 0), row(-yScale * view.up, 0),
                               row(zScale * view.forward, -zScale * near), row(view.forward, 0)));
}

vec3 Camera::directionAt(vec2 place, int width, int height) const {
    const View view = viewOf(*this);
    const float tangent = std::tan(0.5f * verticalFov), aspect = float(width) / float(height);
    const float u = 2 * place.x / float(width) - 1, v = 2 * place.y / float(height) - 1;
    return glm::normalize(view.forward + u * tangent * aspect * view.right - v * tangent * view.up);
}

Camera orbitCamera(const Bounds& bounds, float azimuth, float elevation, float distance, float verticalFov,
                   float aspect) {
    // Stop short of the poles, where the azimuth is undefined.
    const float limit = glm::radians(89.5f);
    const float rise = std::clamp(elevation, -limit, limit);
    const vec3 towardsEye(std::sin(azimuth) * std::cos(rise), std::sin(rise),
                          std::cos(azimuth) * std::cos(rise));
    const float halfAngle = std::atan(std::tan(0.5f * verticalFov) * std::min(1.0f, aspect));
    const float reach = distance * bounds.radius() / std::sin(halfAngle);
    return {bounds.center() + reach * towardsEye, bounds.center(), verticalFov};
}

Camera defaultCamera(const Bounds& bounds, float verticalFov, float aspect) {
    constexpr float kFilled = 0.94f; // share of the image that the box's projection fills
    Camera camera = orbitCamera(bounds, glm::radians(30.0f), glm::radians(12.0f), 1, verticalFov, aspect);
    const View view = viewOf(camera);
    const float tangent = kFilled * std::tan(0.5f * verticalFov);
    float reach = 0; // least distance from which every corner is seen
    for (int corner = 0; corner < 8; corner++) {
        const vec3 place = glm::mix(bounds.low, bounds.high, vec3(corner & 1, corner >> 1 & 1, corner >> 2)) -
                           bounds.center();
        reach = std::max(
            {reach,
             std::abs(glm::dot(place, view.right)) / (tangent * aspect) - glm::dot(place, view.forward),
             std::abs(glm::dot(place, view.up)) / tangent - glm::dot(place, view.forward)});
    }
    camera.eye = camera.target - reach * view.forward;
    return camera;
}

ScreenBox screenBox(const Bounds& bounds, const mat4& clipFromWorld) {
    ScreenBox box;
    for (int corner = 0; corner < 8; corner++) {
        const vec3 point(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                         corner & 4 ? bounds.high.z : bounds.low.z);
        const vec4 clip = clipFromWorld * vec4(point, 1);
        if (!(clip.z >= 0 && clip.w > 0)) return {false, vec2(-1), vec2(1)};
        const vec2 place = vec2(clip) / clip.w;
        box.low = glm::min(box.low, place);
        box.high = glm::max(box.high, place);
    }
    return box;
}

} // namespace relume

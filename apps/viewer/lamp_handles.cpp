#include "apps/viewer/lamp_handles.h"

#include <GLFW/glfw3.h>
#include <cmath>
#include <imgui.h>

namespace relume {

namespace {

constexpr float kSphere = 1.25f;     // radius of the handles' sphere, relative to the object's
constexpr float kSmallestHandle = 7; // pixels
constexpr int kSegments = 96;        // per circle

vec3 directionOf(const LampChoice& lamp, float rotation) {
    return directionAt(lamp.azimuth + rotation, lamp.elevation);
}

// Returns whether a point is on the far side of the sphere.
bool isBehind(vec3 direction, const Camera& camera, const Bounds& model) {
    const vec3 point = kSphere * model.radius() * direction;
    return glm::dot(point, camera.eye - model.center() - point) < 0;
}

float handleRadius(const LampChoice& lamp, const Camera& camera, const Bounds& model, ivec2 size) {
    const float distance = glm::length(camera.eye - model.center());
    const float perUnit = 0.5f * float(size.y) / (std::tan(0.5f * camera.verticalFov) * distance);
    return std::max(kSmallestHandle,
                    perUnit * kSphere * model.radius() * std::sin(glm::radians(lamp.radius)));
}

} // namespace

bool LampHandles::take(const InputEvent& event, LightState& light, const Camera& camera, const Bounds& model,
                       ivec2 size) {
    using Kind = InputEvent::Kind;
    if (light.file || light.lamps.empty()) {
        mHeld.reset();
        return false;
    }
    if (event.kind == Kind::Button && !event.isDown && event.code == GLFW_MOUSE_BUTTON_LEFT && mHeld) {
        mHeld.reset();
        return true;
    }
    if (event.kind == Kind::Move && mHeld && *mHeld < light.lamps.size()) {
        mCursor = event.place;
        drag(light.lamps[*mHeld], light.rotation, camera, model, size);
        return true;
    }
    if (event.kind != Kind::Button || !event.isDown || event.code != GLFW_MOUSE_BUTTON_LEFT ||
        event.modifiers)
        return false;
    for (size_t i = 0; i < light.lamps.size(); i++) {
        const vec3 direction = directionOf(light.lamps[i], light.rotation);
        const auto place = pixelOf(model.center() + kSphere * model.radius() * direction, camera, size);
        if (!place ||
            glm::distance(*place, event.place) > handleRadius(light.lamps[i], camera, model, size) + 3)
            continue;
        mHeld = i;
        mIsBehind = isBehind(direction, camera, model);
        mIsOff = false;
        return true;
    }
    return false;
}

// Keeps the handle under the cursor. Beside the sphere it follows the silhouette; when the cursor returns, it
// is on the other side.
void LampHandles::drag(LampChoice& lamp, float rotation, const Camera& camera, const Bounds& model,
                       ivec2 size) {
    const vec3 ray = camera.pixelDirection(int(mCursor.x), int(mCursor.y), size.x, size.y);
    const vec3 toEye = camera.eye - model.center();
    const float radius = kSphere * model.radius();
    const float along = -glm::dot(toEye, ray); // distance along the ray to its point nearest to the center
    const vec3 nearest = toEye + along * ray;
    const float inside = radius * radius - glm::dot(nearest, nearest);
    if (inside >= 0 && mIsOff) mIsBehind = !mIsBehind;
    mIsOff = inside < 0;
    const float half = std::sqrt(std::max(inside, 0.0f));
    const vec3 direction = glm::normalize(nearest + (mIsBehind ? half : -half) * ray);
    lamp.elevation = glm::degrees(std::asin(std::clamp(direction.y, -1.0f, 1.0f)));
    lamp.azimuth = std::remainder(glm::degrees(std::atan2(direction.x, direction.z)) - rotation, 360.0f);
}

void LampHandles::draw(const LightState& light, const Camera& camera, const Bounds& model, ivec2 size) const {
    if (light.file || light.lamps.empty()) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const vec3 center = model.center();
    const float radius = kSphere * model.radius();
    const auto drawCircle = [&](vec3 x, vec3 y, ImU32 color) {
        std::optional<vec2> last;
        for (int i = 0; i <= kSegments; i++) {
            const float angle = 2 * kPi * float(i) / kSegments;
            const auto place =
                pixelOf(center + radius * (std::cos(angle) * x + std::sin(angle) * y), camera, size);
            if (last && place) list.AddLine({last->x, last->y}, {place->x, place->y}, color, 1);
            last = place;
        }
    };
    constexpr ImU32 kFaint = IM_COL32(160, 160, 160, 90), kShadow = IM_COL32(0, 0, 0, 160);
    const vec3 back = glm::normalize(camera.eye - center);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    drawCircle(right, glm::cross(back, right), kFaint); // approximately the silhouette
    drawCircle({1, 0, 0}, {0, 0, 1}, kFaint);           // the horizon
    for (const LampChoice& lamp : light.lamps) {
        const vec3 direction = directionOf(lamp, light.rotation);
        const auto place = pixelOf(center + radius * direction, camera, size);
        if (!place) continue;
        const vec3 c =
            lamp.color / std::max(1e-3f, std::max(lamp.color.x, std::max(lamp.color.y, lamp.color.z)));
        const ImU32 color = ImGui::GetColorU32({c.x, c.y, c.z, 0.6f});
        const float pixels = handleRadius(lamp, camera, model, size);
        if (isBehind(direction, camera, model)) {
            list.AddCircle({place->x, place->y}, pixels, kShadow, 0, 4);
            list.AddCircle({place->x, place->y}, pixels, color, 0, 2);
        } else {
            list.AddCircleFilled({place->x, place->y}, pixels, color);
            list.AddCircle({place->x, place->y}, pixels, kShadow, 0, 1.5f);
        }
    }
}

} // namespace relume

// The camera as a hand moves it.
#pragma once

#include "engine/scene/camera.h"

#include <optional>

namespace relume {

// About a target, at a distance from it. Angles in radians, azimuth and elevation as orbitCamera() has them.
struct Orbit {
    vec3 target{0};
    float azimuth = 0, elevation = 0, distance = 1;
    float verticalFov = 0.6f;

    bool operator==(const Orbit&) const = default;

    Camera camera() const;

    // By a drag of so many pixels, in an image of this height: the point under the hand follows it.
    void turn(vec2 pixels, float height);
    void pan(vec2 pixels, float height);
    // Nearer by so many steps of the wheel, so that what is under the cursor stays there; `cursor` in [-1,
    // 1], from the image's middle, y down.
    void zoom(float steps, vec2 cursor, float aspect, float radius);
};

// Where a point is seen in an image of this size, in pixels from the upper left; none: behind the eye.
std::optional<vec2> pixelOf(vec3 point, const Camera& camera, ivec2 size);

// What a camera shows.
Orbit orbitOf(const Camera& camera);

// What defaultCamera() shows.
Orbit defaultOrbit(const Bounds& bounds, float verticalFov, float aspect);

} // namespace relume

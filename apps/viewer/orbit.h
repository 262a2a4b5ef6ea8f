// The camera as the user moves it.
#pragma once

#include "engine/scene/camera.h"

#include <optional>

namespace relume {

// A camera at a distance from its target. Angles are in radians; azimuth and elevation are as for
// orbitCamera().
struct Orbit {
    vec3 target{0};
    float azimuth = 0, elevation = 0, distance = 1;
    float verticalFov = 0.6f;

    bool operator==(const Orbit&) const = default;

    Camera camera() const;

    // Moves the camera for a drag in an image of this height, so that the point under the cursor follows it.
    void turn(vec2 pixels, float height);
    void pan(vec2 pixels, float height);
    // Moves nearer by `steps` of the wheel, keeping what is under the cursor in place. `cursor` is in [-1, 1]
    // from the image's center, y down.
    void zoom(float steps, vec2 cursor, float aspect, float radius);
};

// Returns where a point appears in an image of this size, in pixels from the upper left; none if it is behind
// the eye.
std::optional<vec2> pixelOf(vec3 point, const Camera& camera, ivec2 size);

// Returns the orbit of a camera.
Orbit orbitOf(const Camera& camera);

// Returns the orbit of defaultCamera().
Orbit defaultOrbit(const Bounds& bounds, float verticalFov, float aspect);

} // namespace relume

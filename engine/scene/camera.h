// A pinhole camera with a vertical field of view, and where it sees a box.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

struct Camera {
    vec3 eye{0, 0, 1};
    vec3 target{0};
    float verticalFov = 0.6f; // radians

    // Returns the matrix from the world to Vulkan clip space (y down, depth 0 to 1), for an image whose width
    // / height is `aspect`. Near and far planes enclose `scene`.
    mat4 clipFromWorld(float aspect, const Bounds& scene) const;

    // Returns the unit direction through the center of pixel (x, y), counted from the upper left corner.
    vec3 pixelDirection(int x, int y, int width, int height) const {
        return directionAt({float(x) + 0.5f, float(y) + 0.5f}, width, height);
    }
    // Returns the unit direction through any point, in pixels from the upper left corner.
    vec3 directionAt(vec2 place, int width, int height) const;
};

// Returns a camera that looks at the center of `bounds`. Azimuth and elevation are in radians: azimuth 0
// looks along -Z, and the eye moves to the right as it grows; elevation is clamped to ±89.5°. `distance` is
// in multiples of the one at which the bounding sphere just fits the image.
Camera orbitCamera(const Bounds& bounds, float azimuth, float elevation, float distance, float verticalFov,
                   float aspect);

// Returns the default view: the whole object in three-quarter view from slightly above. The bounding box
// fills the image as far as its shape permits, with a margin of 3 % on either side.
Camera defaultCamera(const Bounds& bounds, float verticalFov, float aspect);

// A rectangle in normalized device coordinates. If part of the box is nearer than the near plane,
// `isBeyondNear` is false and the rectangle is the whole screen.
struct ScreenBox {
    bool isBeyondNear = true; // whether the whole box is beyond the near plane
    vec2 low = vec2(1), high = vec2(-1);
};

// Returns the rectangle of the screen that a box covers.
ScreenBox screenBox(const Bounds& bounds, const mat4& clipFromWorld);

} // namespace relume

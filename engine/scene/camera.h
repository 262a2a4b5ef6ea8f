// A pinhole camera with a vertical field of view.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

struct Camera {
    vec3 eye{0, 0, 1};
    vec3 target{0};
    float verticalFov = 0.6f; // radians

    // World to Vulkan clip space (y down, depth 0 to 1), for an image of width / height `aspect`.
    // `scene` bounds what is seen and decides the near and far planes.
    mat4 clipFromWorld(float aspect, const Bounds& scene) const;

    // Unit direction through the center of pixel (x, y), y down from the top.
    vec3 pixelDirection(int x, int y, int width, int height) const {
        return directionAt({float(x) + 0.5f, float(y) + 0.5f}, width, height);
    }
    // Likewise through any place, in pixels from the upper left corner.
    vec3 directionAt(vec2 place, int width, int height) const;
};

// The camera on a sphere about the object that sees all of `bounds`: azimuth and elevation in
// radians (azimuth 0 looks along -Z, growing to the right), distance in multiples of the one that
// just fits the bounding sphere.
Camera orbitCamera(const Bounds& bounds, float azimuth, float elevation, float distance, float verticalFov,
                   float aspect);

// The default view: the whole object from slightly above, three quarters. The bounding box fills the image as
// far as its shape lets it, with a margin of 3 % on either side.
Camera defaultCamera(const Bounds& bounds, float verticalFov, float aspect);

} // namespace relume

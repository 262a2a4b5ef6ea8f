// The footprint of a box: where on the screen it may appear.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// A rectangle in normalized device coordinates. If part of the box is nearer than the near plane,
// `isBeyondNear` is false and the rectangle is the whole screen.
struct Footprint {
    bool isBeyondNear = true; // whether the whole box is beyond the near plane
    vec2 low = vec2(1), high = vec2(-1);
};

// Returns the footprint of a box.
Footprint footprintOf(const Bounds& bounds, const mat4& clipFromWorld);

} // namespace relume

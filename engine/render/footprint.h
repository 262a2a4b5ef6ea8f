// A footprint is where on the screen a box may appear.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// A rectangle in clip space after division. It is the whole screen if some of the box is nearer than the near
// plane.
struct Footprint {
    bool isWhole = true; // none of the box is
    vec2 low = vec2(1), high = vec2(-1);
};

Footprint footprintOf(const Bounds& bounds, const mat4& clipFromWorld);

} // namespace relume

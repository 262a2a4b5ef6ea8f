// Strokes: a painted environment is light with discs of color over it.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

namespace relume {

struct Stroke {
    vec3 direction;      // any length but zero
    float angularRadius; // radians, in (0, π]
    vec3 radiance;
    float softness = 0.5f; // the share of the radius over which it fades, in [0, 1]
    float opacity = 1;     // in its middle, in [0, 1]

    bool operator==(const Stroke&) const = default;
};

// The stroke as the device takes it: amount is its opacity.
shared::LightCap makeStrokeCap(const Stroke& stroke, int size);

// Mixes a stroke into what the cube holds. CPU twin of shaders/light_strokes.comp.
void paintStroke(LightCube& cube, const Stroke& stroke);

} // namespace relume

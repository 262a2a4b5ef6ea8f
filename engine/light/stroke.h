// Strokes: discs of color with which environments are painted.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

namespace relume {

struct Stroke {
    vec3 direction;      // any length but zero
    float angularRadius; // radians, in (0, π]
    vec3 radiance;
    float softness = 0.5f; // the share of the radius over which it fades, in [0, 1]
    float opacity = 1;     // at its center, in [0, 1]

    bool operator==(const Stroke&) const = default;
};

// Returns the stroke as the device takes it; its amount is its opacity.
shared::LightCap makeStrokeCap(const Stroke& stroke, int size);

// Blends a stroke over the cube's radiance. CPU twin of shaders/light_strokes.comp.
void paintStroke(LightCube& cube, const Stroke& stroke);

} // namespace relume

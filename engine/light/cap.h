// Discs on the sphere of directions, averaged over the lighting cube's texels so that they move smoothly.
// Lamps and strokes are made of them.
#pragma once

#include "engine/math/vector.h"
#include "shaders/shared/light.h"

namespace relume {

// Returns a disc around `direction` (any length but zero) of `angularRadius`, in (0, π] radians, for a cube
// of `size` texels a side. It fades, linearly in the distance of unit vectors, from (1 - softness) of the
// radius to all of it, and over at least the width of a sub-cell, so that it does not flicker as it moves. A
// radius below a quarter of a texel's side is raised to that. The caller sets amount and radiance.
shared::LightCap makeCap(vec3 direction, float angularRadius, float softness, int size);

// Returns the share of a texel that a cap covers, in [0, 1]: the mean over cap.side × cap.side sub-cells,
// weighted by solid angle. Continuous in the cap's direction. CPU twin of shaders/lib/light_cap.glsl.
float capCoverage(const shared::LightCap& cap, int face, int x, int y, int size);

// Returns the distance between the ends of unit vectors at an angle, in radians.
float chord(float angle);

// Returns the solid angle of a disc of this angular radius.
float capSolidAngle(float angularRadius);

} // namespace relume

// Polar coordinates of directions about an axis. GLSL twin: shaders/lib/polar_map.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Returns the angle from the axis divided by π, in [0, 1], and the azimuth divided by 2π, in [-½, ½]. `axis`
// and `side` are unit and orthogonal; azimuth 0 is towards `side`, a quarter turn towards axis × side.
vec2 polarPlace(vec3 axis, vec3 side, vec3 direction);

// Returns the unit direction at an angle from the axis and an azimuth, both in radians.
vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth);

} // namespace relume

// Polar coordinates of directions about an axis. GLSL twin of polarDirection(): shaders/lib/polar_map.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Returns the unit direction at an angle from the axis and an azimuth, both in radians. `axis` and `side` are
// unit and orthogonal; azimuth 0 is towards `side`, a quarter turn towards axis × side.
vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth);

} // namespace relume

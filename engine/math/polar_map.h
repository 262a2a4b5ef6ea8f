// Polar maps of directions about an axis. GLSL twin: shaders/lib/polar_map.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Angle from the axis over half a turn, in [0, 1], and azimuth over a whole one, in [-½, ½]: `axis` and
// `side` are unit and orthogonal, azimuth 0 is towards `side`, a quarter turn is axis × side.
vec2 polarPlace(vec3 axis, vec3 side, vec3 direction);

// The unit direction at an angle from the axis and an azimuth, in radians.
vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth);

} // namespace relume

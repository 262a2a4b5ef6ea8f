// Polar coordinates of directions about an axis. C++ twin: engine/math/polar_map.h.
#ifndef RELUME_LIB_POLAR_MAP_GLSL
#define RELUME_LIB_POLAR_MAP_GLSL

const float kTurn = 6.28318530717959;

// Returns the angle from the axis divided by π, and the azimuth divided by 2π, in [-½, ½]. `axis` and `side` are unit
// and orthogonal; azimuth 0 is towards `side`.
vec2 polarPlace(vec3 axis, vec3 side, vec3 direction) {
    const float along = dot(direction, axis), x = dot(direction, side), y = dot(direction, cross(axis, side));
    return vec2(atan(sqrt(x * x + y * y), along) / (0.5 * kTurn), (x == 0 && y == 0 ? 0 : atan(y, x)) / kTurn);
}

// Returns the direction at an angle from the axis and an azimuth, both in radians.
vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth) {
    return sin(angle) * (cos(azimuth) * side + sin(azimuth) * cross(axis, side)) + cos(angle) * axis;
}

#endif

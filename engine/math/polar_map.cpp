#include "engine/math/polar_map.h"

#include <cmath>

namespace relume {

vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth) {
    return std::sin(angle) * (std::cos(azimuth) * side + std::sin(azimuth) * glm::cross(axis, side)) +
           std::cos(angle) * axis;
}

} // namespace relume

#include "engine/math/polar_map.h"

#include <cmath>

namespace relume {

vec2 polarPlace(vec3 axis, vec3 side, vec3 direction) {
    const float along = glm::dot(direction, axis), x = glm::dot(direction, side),
                y = glm::dot(direction, glm::cross(axis, side));
    return {std::atan2(std::sqrt(x * x + y * y), along) / kPi,
            (x == 0 && y == 0 ? 0 : std::atan2(y, x)) / (2 * kPi)};
}

vec3 polarDirection(vec3 axis, vec3 side, float angle, float azimuth) {
    return std::sin(angle) * (std::cos(azimuth) * side + std::sin(azimuth) * glm::cross(axis, side)) +
           std::cos(angle) * axis;
}

} // namespace relume

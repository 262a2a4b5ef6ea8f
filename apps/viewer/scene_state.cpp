#include "apps/viewer/scene_state.h"

#include <cmath>

namespace relume {

Lamp lampOf(const LampChoice& choice) {
    const float azimuth = glm::radians(choice.azimuth), elevation = glm::radians(choice.elevation);
    const float radius = glm::radians(choice.radius), sine = std::sin(radius);
    const vec3 direction(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                         std::cos(azimuth) * std::cos(elevation));
    // Irradiance of a surface that faces it: π sin² radius times its radiance.
    return {direction, radius, choice.brightness / (sine * sine) * choice.color};
}

} // namespace relume

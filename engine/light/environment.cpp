#include "engine/light/environment.h"

#include <algorithm>
#include <cmath>

namespace relume {

vec3 Environment::direction(float column, float row) const {
    const float longitude = kPi - 2 * kPi * column / float(width);
    const float latitude = kPi / 2 - kPi * row / float(height);
    const float across = std::cos(latitude);
    return {std::sin(longitude) * across, std::sin(latitude), std::cos(longitude) * across};
}

vec2 Environment::place(vec3 d) const {
    const float longitude = std::atan2(d.x, d.z);
    const float latitude = std::atan2(d.y, std::sqrt(d.x * d.x + d.z * d.z));
    return {(0.5f - longitude / (2 * kPi)) * float(width), (0.5f - latitude / kPi) * float(height)};
}

vec3 Environment::lookup(vec3 d) const {
    const vec2 centred = place(d) - 0.5f;
    const vec2 low = glm::floor(centred);
    const vec2 weight = centred - low;
    // place() lies in [0, width], so one wrap on either side is enough.
    const int x0 = (int(low.x) + width) % width, x1 = (x0 + 1) % width;
    const int y0 = std::clamp(int(low.y), 0, height - 1), y1 = std::clamp(int(low.y) + 1, 0, height - 1);
    const auto at = [&](int x, int y) { return radiance[size_t(y) * size_t(width) + size_t(x)]; };
    return glm::mix(glm::mix(at(x0, y0), at(x1, y0), weight.x), glm::mix(at(x0, y1), at(x1, y1), weight.x),
                    weight.y);
}

} // namespace relume

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

MapTaps Environment::taps(vec3 d) const {
    const vec2 centered = place(d) - 0.5f;
    const vec2 low = glm::floor(centered);
    // place() lies in [0, width], so one wrap on either side suffices.
    const int x0 = (int(low.x) + width) % width;
    const int y0 = std::clamp(int(low.y), 0, height - 1), y1 = std::clamp(int(low.y) + 1, 0, height - 1);
    return {x0, y0, (x0 + 1) % width, y1, centered - low};
}

vec3 Environment::lookup(vec3 d) const {
    const MapTaps at = taps(d);
    const auto pixel = [&](int x, int y) { return radiance[size_t(y) * size_t(width) + size_t(x)]; };
    return glm::mix(glm::mix(pixel(at.x0, at.y0), pixel(at.x1, at.y0), at.weight.x),
                    glm::mix(pixel(at.x0, at.y1), pixel(at.x1, at.y1), at.weight.x), at.weight.y);
}

std::shared_ptr<const Environment> makePicture(Environment environment) {
    if (environment.width > kMostPictureColumns)
        environment = prepareForSampling(environment, kMostPictureColumns);
    return std::make_shared<const Environment>(std::move(environment));
}

} // namespace relume

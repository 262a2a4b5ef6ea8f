#include "precompute/brdf/isotropic_table.h"

#include <algorithm>
#include <cmath>

namespace relume {

HalfDifference halfDifference(vec3 incoming, vec3 outgoing) {
    // The difference of both directions represents the incoming one: it has the same azimuth about the half
    // vector, and swapping the directions only changes its sign.
    const vec3 sum = incoming + outgoing, difference = incoming - outgoing;
    const float sine = std::sqrt(sum.x * sum.x + sum.y * sum.y), length = glm::length(sum);
    const vec2 axis = sine > 0 ? vec2(sum.x, sum.y) / sine : vec2(1, 0);
    const float along = axis.x * difference.x + axis.y * difference.y;
    float x = (sum.z * along - sine * difference.z) / length;
    float y = axis.x * difference.y - axis.y * difference.x;
    if (y < 0 || (y == 0 && x < 0)) x = -x, y = -y;
    return {std::atan2(sine, sum.z), std::atan2(glm::length(difference), length), std::atan2(y, x)};
}

std::array<vec3, 2> directionsOf(const HalfDifference& angles) {
    const float sine = std::sin(angles.difference), x = sine * std::cos(angles.azimuth),
                y = sine * std::sin(angles.azimuth), z = std::cos(angles.difference);
    const auto tilted = [&](float sign) {
        const float cosineHalf = std::cos(angles.half), sineHalf = std::sin(angles.half);
        return vec3(cosineHalf * sign * x + sineHalf * z, sign * y, cosineHalf * z - sineHalf * sign * x);
    };
    return {tilted(1), tilted(-1)};
}

IsotropicTable::IsotropicTable(int halves, int differences, int azimuths)
    : mHalves(halves), mDifferences(differences), mAzimuths(azimuths),
      mValues(size_t(halves) * size_t(differences) * size_t(azimuths), vec3(0)) {}

HalfDifference IsotropicTable::centerOf(int half, int difference, int azimuth) const {
    const float root = (float(half) + 0.5f) / float(mHalves);
    return {root * root * kPi / 2, (float(difference) + 0.5f) / float(mDifferences) * kPi / 2,
            (float(azimuth) + 0.5f) / float(mAzimuths) * kPi};
}

vec3 IsotropicTable::place(vec3 incoming, vec3 outgoing) const {
    const HalfDifference angles = halfDifference(incoming, outgoing);
    return {std::sqrt(angles.half * (2 / kPi)) * float(mHalves),
            angles.difference * (2 / kPi) * float(mDifferences), angles.azimuth / kPi * float(mAzimuths)};
}

vec3 IsotropicTable::nearest(vec3 incoming, vec3 outgoing) const {
    const vec3 at = place(incoming, outgoing);
    return mValues[cell(std::min(int(at.x), mHalves - 1), std::min(int(at.y), mDifferences - 1),
                        std::min(int(at.z), mAzimuths - 1))];
}

vec3 IsotropicTable::interpolate(vec3 incoming, vec3 outgoing) const {
    const vec3 at = place(incoming, outgoing) - 0.5f;
    const float half = std::clamp(at.x, 0.0f, float(mHalves - 1));
    const float difference = std::clamp(at.y, 0.0f, float(mDifferences - 1));
    const float azimuth = at.z < 0 ? at.z + float(mAzimuths) : at.z; // φd is periodic
    const int h = std::min(int(half), mHalves - 2), d = std::min(int(difference), mDifferences - 2);
    const int a = std::min(int(azimuth), mAzimuths - 1), next = a + 1 == mAzimuths ? 0 : a + 1;
    const auto row = [&](int atHalf, int atDifference) {
        const vec3* values = &mValues[cell(atHalf, atDifference, 0)];
        return glm::mix(values[a], values[next], azimuth - float(a));
    };
    const float across = difference - float(d);
    return glm::mix(glm::mix(row(h, d), row(h, d + 1), across),
                    glm::mix(row(h + 1, d), row(h + 1, d + 1), across), half - float(h));
}

} // namespace relume

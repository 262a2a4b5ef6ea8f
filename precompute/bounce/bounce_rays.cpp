#include "precompute/bounce/bounce_rays.h"

#include "engine/math/hashed_numbers.h"

#include <algorithm>
#include <cmath>

namespace relume {

BounceRays::BounceRays(size_t part, uint32_t vertex) {
    HashedNumbers random(vertex, uint32_t(part));
    for (int axis = 0; axis < 3; axis++) mShift[axis] = random.next();
}

vec3 BounceRays::direction() const {
    const float u = (float(mRay / kSide) + mShift.x) / kSide, v = (float(mRay % kSide) + mShift.y) / kSide;
    const float radius = std::sqrt(u), angle = 2 * kPi * v;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1 - u))};
}

float BounceRays::choice() const {
    constexpr double kGoldenRatio = 0.6180339887498949; // its multiples are evenly distributed
    const double place = double(mShift.z) + mRay * kGoldenRatio;
    return float(place - std::floor(place));
}

} // namespace relume

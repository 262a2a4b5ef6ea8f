// Random directions that are the same on every machine.
#pragma once

#include "engine/math/vector.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace relume {

class RandomDirections {
  public:
    explicit RandomDirections(uint32_t seed) : mRandom(seed) {}

    // Returns a number in [0, 1), made from bits so that every standard library gives the same.
    float uniform() { return float(mRandom() >> 8) * 0x1p-24f; }

    vec3 uniformHemisphere() { return atHeight(1.0f - uniform()); }           // z in (0, 1]
    vec3 cosineHemisphere() { return atHeight(std::sqrt(1.0f - uniform())); } // density cosθ / π

    // Returns a uniformly distributed rotation (Arvo 1992): a rotation about z, then a reflection that takes
    // z anywhere.
    mat3 rotation() {
        const float turn = 2 * kPi * uniform(), around = 2 * kPi * uniform(), height = uniform();
        const mat3 spin(std::cos(turn), -std::sin(turn), 0, std::sin(turn), std::cos(turn), 0, 0, 0, 1);
        const vec3 axis(std::cos(around) * std::sqrt(height), std::sin(around) * std::sqrt(height),
                        std::sqrt(1 - height));
        return (2.0f * glm::outerProduct(axis, axis) - mat3(1)) * spin;
    }

  private:
    vec3 atHeight(float z) {
        const float angle = 2 * kPi * uniform(), radius = std::sqrt(std::max(0.0f, 1 - z * z));
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }

    std::mt19937 mRandom;
};

} // namespace relume

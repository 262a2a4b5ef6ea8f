#include "engine/base/check.h"
#include "precompute/brdf/factorization.h"

#include <cmath>
#include <random>

namespace relume {

namespace {

// In [0, 1), from bits, so that every standard library gives the same.
float uniform(std::mt19937& random) { return float(random() >> 8) * 0x1p-24f; }

vec3 uniformHemisphere(std::mt19937& random) {
    const float z = 1.0f - uniform(random); // in (0, 1]
    const float angle = 2 * kPi * uniform(random);
    const float radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

} // namespace

float factorizationError(const Brdf& brdf, const FactoredBrdf& factored, int pairs) {
    RELUME_CHECK_LE(1, pairs);
    std::mt19937 random(80000);
    glm::dvec3 difference(0), total(0);
    for (int pair = 0; pair < pairs; pair++) {
        const vec3 incoming = uniformHemisphere(random), outgoing = uniformHemisphere(random);
        const double weight = double(incoming.z) * double(outgoing.z);
        const glm::dvec3 exact(brdf.evaluate(incoming, outgoing));
        const glm::dvec3 error = glm::dvec3(evaluate(factored, incoming, outgoing)) - exact;
        difference += error * error * weight * weight;
        total += exact * exact * weight * weight;
    }
    double sum = 0;
    for (int c = 0; c < 3; c++)
        if (total[c] > 0) sum += std::sqrt(difference[c] / total[c]); // a black channel has no error
    return float(sum / 3);
}

} // namespace relume

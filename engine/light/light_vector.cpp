#include "engine/light/light_vector.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace relume {

namespace {

std::vector<vec3> transformFaces(const LightCube& cube, void (*haar)(std::span<vec3>, int)) {
    const size_t faceTexels = size_t(cube.size) * size_t(cube.size);
    RELUME_CHECK_EQ(cube.radiance.size(), size_t(kCubeFaces) * faceTexels);
    std::vector<vec3> values = cube.radiance;
    for (size_t face = 0; face < kCubeFaces; face++)
        haar(std::span(values).subspan(face * faceTexels, faceTexels), cube.size);
    return values;
}

float largestComponent(const std::vector<vec3>& coefficients) {
    float largest = 0;
    for (const vec3& c : coefficients)
        for (int channel = 0; channel < 3; channel++) {
            RELUME_CHECK(std::isfinite(c[channel]));
            largest = std::max(largest, std::abs(c[channel]));
        }
    return largest;
}

// Rounds to nearest, halves away from zero.
ivec3 quantise(vec3 coefficient, float largest, int maximum) {
    return ivec3(glm::sign(coefficient) *
                 glm::floor(glm::abs(coefficient) / largest * float(maximum) + 0.5f));
}

int largestMagnitude(ivec3 q) { return std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}); }

} // namespace

int lightMaximumFor(uint32_t magnitudeSum) {
    if (magnitudeSum <= kLightSumLimit) return kLightMaximum;
    // Rounding moves each entry by a half, a little more in floats: n covers it before and after.
    constexpr uint32_t kMaximum = kLightMaximum, n = kMaximumLightEntries;
    const uint32_t coarsening = (magnitudeSum + n + kMaximum - 1) / kMaximum;
    return int((kLightSumLimit - n) / coarsening);
}

LightVector makeLightVector(const LightCube& cube, int threshold) {
    RELUME_CHECK_LE(cube.radiance.size(), size_t(kMaximumLightEntries));
    const std::vector<vec3> coefficients = transformFaces(cube, haarForward);
    const float largest = largestComponent(coefficients);
    LightVector vector{.faceSize = cube.size, .scale = 0, .indices = {}, .values = {}};
    if (largest == 0) return vector;

    std::vector<uint32_t> kept;
    glm::u32vec3 sums(0);
    for (uint32_t i = 0; i < coefficients.size(); i++) {
        const ivec3 q = quantise(coefficients[i], largest, kLightMaximum);
        if (largestMagnitude(q) < std::max(threshold, 1)) continue;
        kept.push_back(i);
        sums += glm::u32vec3(glm::abs(q));
    }

    const int maximum = lightMaximumFor(std::max({sums.x, sums.y, sums.z}));
    vector.scale = largest / float(maximum);
    for (uint32_t i : kept) {
        const ivec3 q = quantise(coefficients[i], largest, maximum);
        if (q == ivec3(0)) continue;
        vector.indices.push_back(uint16_t(i));
        vector.values.push_back({int16_t(q.x), int16_t(q.y), int16_t(q.z)});
    }
    return vector;
}

LightCube reconstruct(const LightVector& vector) {
    RELUME_CHECK_EQ(vector.indices.size(), vector.values.size());
    LightCube cube{vector.faceSize, {}};
    cube.radiance.assign(size_t(kCubeFaces) * size_t(cube.size) * size_t(cube.size), vec3(0));
    for (size_t e = 0; e < vector.indices.size(); e++) {
        const auto& q = vector.values[e];
        cube.radiance[vector.indices[e]] = vector.scale * vec3(q[0], q[1], q[2]);
    }
    cube.radiance = transformFaces(cube, haarInverse);
    return cube;
}

} // namespace relume

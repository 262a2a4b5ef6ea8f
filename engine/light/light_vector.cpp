#include "engine/light/light_vector.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Coefficients that a device may flush to zero are zero.
float componentOf(float coefficient) {
    RELUME_CHECK(std::isfinite(coefficient));
    return std::abs(coefficient) < std::numeric_limits<float>::min() ? 0 : coefficient;
}

float largestComponent(vec3 c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

// Rounds to nearest, halves away from zero. In double, where none of this rounds.
ivec3 quantise(vec3 coefficient, double step) {
    const glm::dvec3 c(coefficient);
    return ivec3(glm::sign(c) * glm::floor(glm::abs(c) / step + 0.5));
}

} // namespace

float keptShare(int threshold) { return std::max(float(threshold) - 0.5f, 0.0f) / float(kLightMaximum); }

LightVector makeLightVector(const LightCube& cube, int threshold) {
    RELUME_CHECK_LE(cube.radiance.size(), size_t(kMaximumLightEntries));
    std::vector<vec3> coefficients = transformFaces(cube, haarForward);
    float largest = 0;
    for (vec3& c : coefficients) {
        c = {componentOf(c.x), componentOf(c.y), componentOf(c.z)};
        largest = std::max(largest, largestComponent(c));
    }
    LightVector vector{.faceSize = cube.size, .scale = 0, .indices = {}, .values = {}};
    if (largest == 0) return vector;

    const float least = largest * keptShare(threshold);
    std::vector<uint32_t> kept;
    for (uint32_t i = 0; i < coefficients.size(); i++)
        if (largestComponent(coefficients[i]) >= least) kept.push_back(i);

    const auto fits = [&](double step) {
        glm::u64vec3 sum(0);
        for (uint32_t i : kept) sum += glm::u64vec3(glm::abs(quantise(coefficients[i], step)));
        return std::max({sum.x, sum.y, sum.z}) <= kLightSumLimit;
    };
    double step = double(std::numeric_limits<float>::min());
    while (double(largest) / step > kLightMaximum) step *= 2;
    while (!fits(step)) step *= 2;
    vector.scale = float(step);
    for (uint32_t i : kept) {
        const ivec3 q = quantise(coefficients[i], step);
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

#include "engine/light/light_vector.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "shaders/shared/light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace relume {

namespace {

LightCube dropFaintTexels(LightCube cube) {
    for (vec3& texel : cube.radiance)
        for (int c = 0; c < 3; c++) {
            RELUME_CHECK(std::isfinite(texel[c]));
            if (std::abs(texel[c]) < shared::kLeastRadiance) texel[c] = 0;
        }
    return cube;
}

// Replaces weights that a device may flush to zero by zero.
float flushDenormal(float weight) { return weight < std::numeric_limits<float>::min() ? 0 : weight; }

float largestComponent(vec3 c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

double lengthSquared(glm::dvec3 v) { return glm::dot(v, v); }

// Returns the share of its face that a Haar function covers: 4^-level, where the average has level 0.
float areaOf(int x, int y) {
    const int side = std::max(1, int(std::bit_floor(unsigned(std::max(x, y)))));
    return 1.0f / float(side * side);
}

// Returns the indices of the kept entries, ascending.
std::vector<uint32_t> select(const std::vector<vec3>& coefficients, int size,
                             const LightSelection& selection) {
    std::vector<float> weights;
    for (uint32_t i = 0; i < coefficients.size(); i++) {
        const int x = int(i) % size, y = int(i) / size % size;
        weights.push_back(flushDenormal(largestComponent(coefficients[i]) *
                                        (selection.isAreaWeighted() ? areaOf(x, y) : 1.0f)));
    }
    std::vector<uint32_t> kept;
    for (uint32_t i = 0; i < weights.size(); i++)
        if (weights[i] > 0) kept.push_back(i);
    if (!selection.threshold) {
        RELUME_CHECK(selection.count > 0);
        std::ranges::stable_sort(kept, std::ranges::greater(), [&](uint32_t i) { return weights[i]; });
        kept.resize(std::min(kept.size(), size_t(selection.count)));
        std::ranges::sort(kept);
    } else {
        const float least = std::ranges::max(weights) * shareOf(*selection.threshold);
        std::erase_if(kept, [&](uint32_t i) { return weights[i] < least; });
    }
    return kept;
}

// Rounds to nearest, halves away from zero. In double precision, the division is exact.
ivec3 quantize(vec3 coefficient, double step) {
    const glm::dvec3 c(coefficient);
    return ivec3(glm::sign(c) * glm::floor(glm::abs(c) / step + 0.5));
}

} // namespace

LightVector makeLightVector(const LightCube& cube, const LightSelection& selection) {
    RELUME_CHECK_LE(cube.radiance.size(), size_t(kMaximumLightEntries));
    std::vector<vec3> coefficients = dropFaintTexels(cube).radiance;
    haarForwardFaces(coefficients, cube.size);
    float largest = 0;
    for (const vec3& c : coefficients) largest = std::max(largest, largestComponent(c));
    LightVector vector{.faceSize = cube.size, .scale = 0, .error = 0, .indices = {}, .values = {}};
    if (largest == 0) return vector;

    const std::vector<uint32_t> kept = select(coefficients, cube.size, selection);
    const auto fits = [&](double step) {
        glm::u64vec3 sum(0);
        for (uint32_t i : kept) sum += glm::u64vec3(glm::abs(quantize(coefficients[i], step)));
        return std::max({sum.x, sum.y, sum.z}) <= kLightSumLimit;
    };
    double step = double(std::numeric_limits<float>::min());
    while (double(largest) / step > kLightMaximum) step *= 2;
    while (!fits(step)) step *= 2;
    vector.scale = float(step);
    double energy = 0, lost = 0; // in double precision, so that no power of two overflows
    for (const vec3& c : coefficients) energy += lengthSquared(glm::dvec3(c));
    lost = energy;
    for (uint32_t i : kept) {
        const ivec3 q = quantize(coefficients[i], step);
        if (q == ivec3(0)) continue;
        const glm::dvec3 c(coefficients[i]);
        lost += lengthSquared(c - step * glm::dvec3(q)) - lengthSquared(c);
        vector.indices.push_back(uint16_t(i));
        vector.values.push_back({int16_t(q.x), int16_t(q.y), int16_t(q.z)});
    }
    vector.error = float(std::sqrt(std::max(lost, 0.0) / energy));
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
    haarInverseFaces(cube.radiance, cube.size);
    return cube;
}

} // namespace relume

#include "precompute/error/low_order_light.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Returns the real spherical harmonics of degree l and order m = -l..l at index l² + l + m.
std::vector<float> harmonics(vec3 direction, int order) {
    const double theta = std::acos(std::clamp(double(direction.z), -1.0, 1.0));
    const double phi = std::atan2(double(direction.y), double(direction.x));
    std::vector<float> values(size_t(order) * size_t(order));
    for (int l = 0; l < order; l++)
        for (int m = 0; m <= l; m++) {
            const double polar =
                std::sph_legendre(unsigned(l), unsigned(m), theta) * (m > 0 ? std::sqrt(2.0) : 1);
            values[size_t(l * l + l + m)] = float(polar * std::cos(m * phi));
            if (m > 0) values[size_t(l * l + l - m)] = float(polar * std::sin(m * phi));
        }
    return values;
}

} // namespace

LightCube lowOrderLight(const LightCube& light, int order) {
    RELUME_CHECK(order >= 1 && order <= 16);
    const int size = light.size;
    const size_t texels = light.radiance.size(), bands = size_t(order) * size_t(order);
    std::vector<std::vector<float>> values(texels);
    // In one thread: std::sph_legendre() calls lgamma(), which writes a global variable.
    for (int row = 0; row < kCubeFaces * size; row++)
        for (int x = 0; x < size; x++)
            values[size_t(row * size + x)] =
                harmonics(cubeTexelDirection(row / size, x, row % size, size), order);
    std::vector<glm::dvec3> coefficients(bands, glm::dvec3(0));
    for (size_t texel = 0; texel < texels; texel++) {
        const int x = int(texel) % size, y = int(texel) / size % size;
        const glm::dvec3 energy(cubeTexelSolidAngle(x, y, size) * light.radiance[texel]);
        for (size_t band = 0; band < bands; band++)
            coefficients[band] += double(values[texel][band]) * energy;
    }
    LightCube low{size, std::vector<vec3>(texels)};
    for (size_t texel = 0; texel < texels; texel++) {
        glm::dvec3 sum(0);
        for (size_t band = 0; band < bands; band++) sum += double(values[texel][band]) * coefficients[band];
        low.radiance[texel] = vec3(sum);
    }
    return low;
}

} // namespace relume

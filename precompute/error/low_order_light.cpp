#include "precompute/error/low_order_light.h"

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/math/cubemap.h"

#include <cmath>
#include <complex>
#include <glm/gtc/constants.hpp>
#include <span>

namespace relume {

namespace {

// Computes the real spherical harmonics of degree l and order m = -l..l at index l² + l + m, by the
// recurrences of normalized associated Legendre functions (Press et al.: Numerical Recipes, third
// edition, 6.7). Those of order m are divided by sin^m θ, which is in the power of x + iy.
void harmonics(vec3 direction, int order, std::span<float> values) {
    const double z = direction.z;
    const std::complex<double> across(direction.x, direction.y);
    std::complex<double> power = 1;
    double sectoral = std::sqrt(0.25 / glm::pi<double>());
    for (int m = 0; m < order; m++) {
        if (m > 0) power *= across, sectoral *= std::sqrt((2 * m + 1) / (2.0 * m));
        double before = 0, legendre = (m > 0 ? std::sqrt(2.0) : 1) * sectoral;
        for (int l = m; l < order; l++) {
            values[size_t(l * l + l + m)] = float(legendre * power.real());
            if (m > 0) values[size_t(l * l + l - m)] = float(legendre * power.imag());
            const double next = std::sqrt((4.0 * (l + 1) * (l + 1) - 1) / ((l + 1) * (l + 1) - m * m)) *
                                (z * legendre - std::sqrt((l * l - m * m) / (4.0 * l * l - 1)) * before);
            before = legendre, legendre = next;
        }
    }
}

} // namespace

LightCube lowOrderLight(const LightCube& light, int order) {
    RELUME_CHECK(order >= 1 && order <= 16);
    const int size = light.size;
    const size_t texels = light.radiance.size(), bands = size_t(order) * size_t(order);
    std::vector<float> values(texels * bands); // [texel][band]
    const auto valuesOf = [&](size_t texel) { return std::span(values).subspan(texel * bands, bands); };
    parallelFor(size_t(kCubeFaces * size), [&](size_t row) {
        for (int x = 0; x < size; x++)
            harmonics(cubeTexelDirection(int(row) / size, x, int(row) % size, size), order,
                      valuesOf(row * size_t(size) + size_t(x)));
    });
    std::vector<glm::dvec3> coefficients(bands, glm::dvec3(0));
    for (size_t texel = 0; texel < texels; texel++) {
        const int x = int(texel) % size, y = int(texel) / size % size;
        const glm::dvec3 energy(cubeTexelSolidAngle(x, y, size) * light.radiance[texel]);
        for (size_t band = 0; band < bands; band++)
            coefficients[band] += double(valuesOf(texel)[band]) * energy;
    }
    LightCube low{size, std::vector<vec3>(texels)};
    for (size_t texel = 0; texel < texels; texel++) {
        glm::dvec3 sum(0);
        for (size_t band = 0; band < bands; band++) sum += double(valuesOf(texel)[band]) * coefficients[band];
        low.radiance[texel] = vec3(sum);
    }
    return low;
}

} // namespace relume

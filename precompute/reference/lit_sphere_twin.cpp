#include "precompute/reference/lit_sphere_twin.h"

#include "engine/math/cubemap.h"
#include "engine/math/polar_map.h"
#include "engine/math/tangent_frame.h"

#include <array>
#include <cmath>
#include <complex>

namespace relume {

using namespace shared;

std::vector<vec3> sphereCube(const LightCube& light) {
    constexpr int kSize = kSphereCube, kBordered = kSphereCubeBordered;
    const int side = light.size / kSize;
    std::vector<vec3> texels;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = -1; y <= kSize; y++)
            for (int x = -1; x <= kSize; x++) {
                const auto coordinate = [](int texel) {
                    return (float(texel) + 0.5f) * 2 / float(kSize) - 1;
                };
                const CubeTexel seen = cubeTexel(cubeDirection(face, coordinate(x), coordinate(y)), kSize);
                vec3 sum(0);
                for (int j = 0; j < side; j++)
                    for (int i = 0; i < side; i++)
                        sum += light.radiance[size_t(
                            cubeTexelIndex(seen.face, seen.x * side + i, seen.y * side + j, light.size))];
                texels.push_back(sum / float(side * side));
            }
    static_assert(kBordered == kSize + 2);
    return texels;
}

std::vector<CellLight> cellLights(const LightCube& light) {
    constexpr int kSize = kTupleCells;
    const int side = light.size / kSize;
    std::vector<CellLight> lights;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                vec3 energy(0), weighted(0);
                for (int j = y * side; j < (y + 1) * side; j++)
                    for (int i = x * side; i < (x + 1) * side; i++) {
                        const vec3 emitted = cubeTexelSolidAngle(i, j, light.size) *
                                             light.radiance[size_t(cubeTexelIndex(face, i, j, light.size))];
                        energy += emitted;
                        weighted += (std::abs(emitted.x) + std::abs(emitted.y) + std::abs(emitted.z)) *
                                    cubeTexelDirection(face, i, j, light.size);
                    }
                const bool isLit = glm::dot(weighted, weighted) > 0;
                lights.push_back(
                    {isLit ? glm::normalize(weighted) : cubeTexelDirection(face, x, y, kSize), energy});
            }
    return lights;
}

std::vector<vec3> unshadowedTuples(const std::vector<CellLight>& lights, const FactoredBrdf& factors) {
    std::vector<vec3> tuples;
    for (uint32_t ring = 0; ring < kTupleRings; ring++)
        for (uint32_t azimuth = 0; azimuth < kTupleAzimuths; azimuth++) {
            const TangentFrame frame = tangentFrame(
                polarDirection({0, 1, 0}, {1, 0, 0}, (float(ring) + 0.5f) * kPi / float(kTupleRings),
                               (float(azimuth) + 0.5f) * 2 * kPi / float(kTupleAzimuths)));
            for (int term = 0; term < factors.terms; term++) {
                vec3 sum(0);
                for (const CellLight& light : lights) {
                    const vec3 local = frame.toLocal(light.direction);
                    if (local.z > kGrazingCosine)
                        sum += local.z * light.energy *
                               lookupMap(factors.lightMap(term), factors.size, factors.mapping, local);
                }
                tuples.push_back(sum);
            }
        }
    return tuples;
}

std::vector<vec3> polarLight(const std::vector<vec3>& cube, vec3 direction) {
    constexpr int kSide = 3; // samples of a cell on either side
    const TangentFrame frame = tangentFrame(direction);
    const auto lookup = [&](vec3 d) {
        const int face = cubeTexel(d, 1).face;
        const CubeFaceAxes axes = cubeFaceAxes(face);
        const vec2 uv = vec2(glm::dot(d, axes.right), glm::dot(d, axes.down)) / glm::dot(d, axes.forward);
        const vec2 place = (uv + 1.0f) * (0.5f * float(kSphereCube)) + 0.5f;
        const ivec2 low = glm::min(ivec2(place), ivec2(kSphereCubeBordered - 2));
        const vec2 weight = place - vec2(low);
        const auto at = [&](int x, int y) {
            return cube[size_t((face * int(kSphereCubeBordered) + low.y + y) * int(kSphereCubeBordered) +
                               low.x + x)];
        };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), weight.x), glm::mix(at(0, 1), at(1, 1), weight.x),
                        weight.y);
    };
    const float ringWidth = kPi / float(kSphereRings), width = 2 * kPi / float(kSphereAzimuths);
    std::vector<vec3> polar;
    for (uint32_t ring = 0; ring < kSphereRings; ring++)
        for (uint32_t azimuth = 0; azimuth < kSphereAzimuths; azimuth++) {
            vec3 sum(0);
            float weights = 0;
            for (int j = 0; j < kSide; j++)
                for (int i = 0; i < kSide; i++) {
                    const float angle = (float(ring) + (float(j) + 0.5f) / kSide) * ringWidth;
                    const float turn = (float(azimuth) - 0.5f + (float(i) + 0.5f) / kSide) * width;
                    sum += std::sin(angle) * lookup(polarDirection(frame.n, frame.s, angle, turn));
                    weights += std::sin(angle);
                }
            const float solidAngle =
                width * (std::cos(float(ring) * ringWidth) - std::cos(float(ring + 1) * ringWidth));
            polar.push_back(sum * (solidAngle / weights));
        }
    return polar;
}

std::vector<vec3> litSphere(const SphereKernel& kernel, const std::vector<vec3>& polar, vec3 direction) {
    using Complex = std::complex<double>;
    const auto phase = [](double turns) { return std::polar(1.0, turns * 2 * double(kPi)); };
    const TangentFrame axes = tangentFrame(direction);
    const auto viewTurn = [&](uint32_t ring, uint32_t azimuth) {
        const vec3 normal =
            polarDirection(axes.n, axes.s, (float(ring) + 0.5f) * kPi / 2 / float(kSphereRings),
                           float(azimuth) * 2 * kPi / float(kSphereAzimuths));
        const vec3 local = tangentFrame(normal).toLocal(direction);
        return double(std::atan2(local.y, local.x) / (2 * kPi));
    };
    std::vector<vec3> sphere(kSphereRings * kSphereAzimuths, vec3(0));
    int component = 0;
    const auto add = [&](int harmonic, int m) {
        const vec3* values = &kernel.values[size_t(component++) * kSphereRings * kSphereRings];
        std::vector<std::array<Complex, 3>> light(kSphereRings);
        for (uint32_t ring = 0; ring < kSphereRings; ring++)
            for (uint32_t azimuth = 0; azimuth < kSphereAzimuths; azimuth++)
                for (int channel = 0; channel < 3; channel++)
                    light[ring][size_t(channel)] += double(polar[ring * kSphereAzimuths + azimuth][channel]) *
                                                    phase(-double(m) * azimuth / kSphereAzimuths);
        for (uint32_t row = 0; row < kSphereRings; row++) {
            std::array<Complex, 3> sum{};
            for (uint32_t ring = 0; ring < kSphereRings; ring++)
                for (int channel = 0; channel < 3; channel++)
                    sum[size_t(channel)] +=
                        double(values[row * kSphereRings + ring][channel]) * light[ring][size_t(channel)];
            for (uint32_t azimuth = 0; azimuth < kSphereAzimuths; azimuth++) {
                const double turns = double(m) * azimuth / kSphereAzimuths +
                                     (harmonic == 0 ? 0 : 2 * harmonic * viewTurn(row, azimuth));
                for (int channel = 0; channel < 3; channel++)
                    sphere[row * kSphereAzimuths + azimuth][channel] +=
                        float((phase(turns) * sum[size_t(channel)]).real());
            }
        }
    };
    for (int m = 0; m <= kernel.frequencies; m++) add(0, m);
    for (int harmonic = 1; harmonic <= kernel.harmonics; harmonic++)
        for (int m = -kernel.frequencies; m <= kernel.frequencies; m++) add(harmonic, m);
    return sphere;
}

} // namespace relume

#include "precompute/twins/lit_sphere_twin.h"

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

std::vector<CellLight> cellLights(const LightCube& light, const LightCube& whole) {
    constexpr int kSize = kTupleCells;
    const int side = light.size / kSize;
    std::vector<CellLight> lights;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                vec3 energy(0), weighted(0);
                for (int j = y * side; j < (y + 1) * side; j++)
                    for (int i = x * side; i < (x + 1) * side; i++) {
                        const auto texel = size_t(cubeTexelIndex(face, i, j, light.size));
                        const float solidAngle = cubeTexelSolidAngle(i, j, light.size);
                        energy += solidAngle * light.radiance[texel];
                        weighted += glm::dot(glm::abs(whole.radiance[texel]), vec3(solidAngle)) *
                                    cubeTexelDirection(face, i, j, light.size);
                    }
                const bool isLit = glm::dot(weighted, weighted) > 0;
                lights.push_back(
                    {isLit ? glm::normalize(weighted) : cubeTexelDirection(face, x, y, kSize), energy});
            }
    return lights;
}

std::vector<vec3> unshadowedTuples(const std::vector<CellLight>& lights, const FactoredBrdf& factors,
                                   bool isTurned) {
    std::vector<vec3> tuples;
    const auto add = [&](const TangentFrame& frame) {
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
    };
    const auto normalAt = [](uint32_t ring, uint32_t azimuth) {
        return polarDirection({0, 1, 0}, {1, 0, 0}, (float(ring) + 0.5f) * kPi / float(kTupleRings),
                              (float(azimuth) + 0.5f) * 2 * kPi / float(kTupleAzimuths));
    };
    for (uint32_t ring = 0; !isTurned && ring < kTupleRings; ring++)
        for (uint32_t azimuth = 0; azimuth < kTupleAzimuths; azimuth++)
            add(tangentFrame(normalAt(ring, azimuth)));
    for (uint32_t row = 0; isTurned && row < kTurnedRows; row++) {
        const bool isBelow = row >= kTurnedRows / 2;
        const uint32_t ring = row % kTupleSideRings + (isBelow ? kTupleRings - kTupleSideRings : 0);
        const auto turn = float(row / kTupleSideRings % kTupleTurns) * 2 * kPi / float(kTupleTurns);
        for (uint32_t azimuth = 0; azimuth < kTupleAzimuths; azimuth++) {
            const vec3 normal = normalAt(ring, azimuth);
            const TangentFrame frame = isBelow ? lowerTangentFrame(normal) : tangentFrame(normal);
            add(tangentFrame(normal, std::cos(turn) * frame.s + std::sin(turn) * frame.t));
        }
    }
    return tuples;
}

std::vector<vec3> polarLight(const std::vector<vec3>& cube, vec3 direction) {
    constexpr int kSide = 2; // samples per side of a cell
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

std::vector<vec3> litSpheres(const SphereKernel& kernel, const std::vector<vec3>& polar) {
    using Complex = std::complex<double>;
    constexpr size_t kTexels = size_t(kSphereRings) * kSphereAzimuths;
    const auto phase = [](double turns) { return std::polar(1.0, turns * 2 * double(kPi)); };
    std::vector<vec3> spheres(size_t(2 * kernel.harmonics + 1) * kTexels, vec3(0));
    int component = 0;
    const auto add = [&](int harmonic, int m) {
        const vec3* values = &kernel.values[size_t(component++) * kSphereRings * kSphereRings];
        std::vector<std::array<Complex, 3>> light(kSphereRings);
        for (uint32_t ring = 0; ring < kSphereRings; ring++)
            for (uint32_t azimuth = 0; azimuth < kSphereAzimuths; azimuth++)
                for (int channel = 0; channel < 3; channel++)
                    light[ring][size_t(channel)] += double(polar[ring * kSphereAzimuths + azimuth][channel]) *
                                                    phase(-double(m) * azimuth / kSphereAzimuths);
        vec3* const real = &spheres[size_t(harmonic == 0 ? 0 : 2 * harmonic - 1) * kTexels];
        for (uint32_t row = 0; row < kSphereRings; row++) {
            std::array<Complex, 3> sum{};
            for (uint32_t ring = 0; ring < kSphereRings; ring++)
                for (int channel = 0; channel < 3; channel++)
                    sum[size_t(channel)] +=
                        double(values[row * kSphereRings + ring][channel]) * light[ring][size_t(channel)];
            for (uint32_t azimuth = 0; azimuth < kSphereAzimuths; azimuth++)
                for (int channel = 0; channel < 3; channel++) {
                    const Complex value = phase(double(m) * azimuth / kSphereAzimuths) * sum[size_t(channel)];
                    const size_t texel = row * kSphereAzimuths + azimuth;
                    real[texel][channel] += float(value.real());
                    if (harmonic > 0) real[kTexels + texel][channel] += float(value.imag());
                }
        }
    };
    for (int m = 0; m <= kernel.frequencies; m++) add(0, m);
    for (int harmonic = 1; harmonic <= kernel.harmonics; harmonic++)
        for (int m = -kernel.frequencies; m <= kernel.frequencies; m++) add(harmonic, m);
    return spheres;
}

vec3 litSphereRadiance(const SphereKernel& kernel, const std::vector<vec3>& spheres, size_t texel,
                       float azimuth) {
    constexpr size_t kTexels = size_t(kSphereRings) * kSphereAzimuths;
    vec3 sum = spheres[texel];
    for (int harmonic = 1; harmonic <= kernel.harmonics; harmonic++) {
        const vec3* const real = &spheres[size_t(2 * harmonic - 1) * kTexels];
        sum += std::cos(2 * float(harmonic) * azimuth) * real[texel] -
               std::sin(2 * float(harmonic) * azimuth) * real[kTexels + texel];
    }
    return sum;
}

} // namespace relume

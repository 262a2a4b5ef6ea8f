#include "engine/light/light_cube.h"

#include "engine/base/check.h"
#include "engine/light/cube_cells.h"
#include "engine/light/light_footprint.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

LightCube emptyCube(int size) {
    RELUME_CHECK(size > 0);
    return {size, std::vector<vec3>(size_t(kCubeFaces) * size_t(size) * size_t(size), vec3(0))};
}

// Mean of `value(direction)` over a texel, by `count` × `count` sub-cells weighted by solid angle.
template <typename Value>
auto texelMean(int face, int x, int y, int size, int count, Value value) {
    decltype(value(vec3())) sum(0);
    float weights = 0;
    forEachSubCell(face, x, y, size, count, [&](vec3 direction, float weight) {
        sum += weight * value(direction);
        weights += weight;
    });
    return sum / weights;
}

// Angle between unit vectors, accurate for small angles too.
float angleBetween(vec3 a, vec3 b) { return 2 * std::asin(std::min(1.0f, 0.5f * glm::length(a - b))); }

} // namespace

LightCube sampleEnvironment(const Environment& prepared, int size, float rotation) {
    LightCube cube = emptyCube(size);
    const LightFootprints footprints = makeLightFootprints(prepared.width, prepared.height, size);
    const ColumnShift shift = columnShift(rotation, prepared.width);
    const uint32_t width = uint32_t(prepared.width);
    for (size_t texel = 0; texel < cube.radiance.size(); texel++)
        for (uint32_t entry = footprints.starts[texel]; entry < footprints.starts[texel + 1]; entry++) {
            const auto& [place, weight] = footprints.pixels[entry];
            const uint32_t left = ((place & 0xffff) + shift.whole) % width, right = (left + 1) % width;
            const vec3* row = &prepared.radiance[size_t(place >> 16) * width];
            cube.radiance[texel] += weight * glm::mix(row[left], row[right], shift.fraction);
        }
    return cube;
}

LightCube makeDistantLight(vec3 direction, vec3 irradiance, int size) {
    RELUME_CHECK(glm::length(direction) > 0);
    LightCube cube = emptyCube(size);
    const CubeTexel texel = cubeTexel(direction, size);
    cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, size))] =
        irradiance / cubeTexelSolidAngle(texel.x, texel.y, size);
    return cube;
}

LightCube makeSphereLight(vec3 direction, float angularRadius, vec3 radiance, int size) {
    RELUME_CHECK(glm::length(direction) > 0);
    RELUME_CHECK(angularRadius > 0 && angularRadius <= kPi);
    LightCube cube = emptyCube(size);
    const vec3 centre = glm::normalize(direction);
    const float half = std::sin(angularRadius / 2);
    const float solidAngle = 4 * kPi * half * half;

    // Eight sub-cells to the radius, within reason.
    constexpr int kFewest = 8, kMost = 256;
    const float cells = 8 * 2 / (float(size) * angularRadius);
    const int count = int(std::clamp(std::ceil(cells), float(kFewest), float(kMost)));
    const float reach = angularRadius + std::sqrt(2.0f) / float(size); // a texel's half diagonal, at most
    double covered = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                if (angleBetween(cubeTexelDirection(face, x, y, size), centre) > reach) continue;
                const float fraction = texelMean(face, x, y, size, count, [&](vec3 d) {
                    return angleBetween(glm::normalize(d), centre) <= angularRadius ? 1.0f : 0.0f;
                });
                cube.radiance[size_t(cubeTexelIndex(face, x, y, size))] = fraction * radiance;
                covered += double(fraction) * double(cubeTexelSolidAngle(x, y, size));
            }
    if (covered == 0) return makeDistantLight(direction, radiance * solidAngle, size);
    const float correction = float(solidAngle / covered);
    for (vec3& texel : cube.radiance) texel *= correction;
    return cube;
}

} // namespace relume

// The built-in sky. It does not model the atmosphere but shows glossy objects well: a bright soft sun, a
// gradient, clouds that reflections move over, and a darker ground.
#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/light/environment.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr float kDiscRadius = 3 * kPi / 180;
constexpr float kSunElevation = 42 * kPi / 180, kSunLongitude = 40 * kPi / 180;

// Returns a pseudorandom value in [0, 1) per lattice point, by the finalizer of MurmurHash3.
float latticeValue(ivec3 p) {
    uint32_t h = uint32_t(p.x) * 0x8da6b343u ^ uint32_t(p.y) * 0xd8163841u ^ uint32_t(p.z) * 0xcb1ab31fu;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return float((h ^ (h >> 16)) >> 8) / 16777216.0f;
}

// Returns value noise with smoothstep interpolation, in [0, 1).
float noise(vec3 p) {
    const vec3 low = glm::floor(p);
    const vec3 t = (p - low) * (p - low) * (3.0f - 2.0f * (p - low));
    const ivec3 cell(low);
    const auto edge = [&](int y, int z) {
        return glm::mix(latticeValue(cell + ivec3(0, y, z)), latticeValue(cell + ivec3(1, y, z)), t.x);
    };
    return glm::mix(glm::mix(edge(0, 0), edge(1, 0), t.y), glm::mix(edge(0, 1), edge(1, 1), t.y), t.z);
}

// Returns the cloud cover in [0, 1] of a flat layer seen from below, thinning out towards the horizon.
float clouds(vec3 d) {
    if (d.y <= 0) return 0;
    const vec3 p = vec3(d.x, 0, d.z) * (2.0f / (d.y + 0.25f));
    float sum = 0, size = 0.5f;
    for (float frequency : {1.0f, 2.1f, 4.3f, 8.7f}) {
        sum += size * noise(frequency * p + vec3(17.3f, 5.1f * frequency, 40.7f));
        size *= 0.5f;
    }
    return glm::smoothstep(0.46f, 0.68f, sum) * glm::smoothstep(0.02f, 0.25f, d.y);
}

vec3 skyRadiance(vec3 d, vec3 sun) {
    const vec3 zenith(0.10f, 0.23f, 0.58f), blue(0.32f, 0.52f, 0.88f), horizon(1.15f, 0.95f, 0.76f);
    const vec3 cloud(1.7f, 1.62f, 1.5f), sunlight(1.0f, 0.90f, 0.74f);
    const vec3 soilNear(0.21f, 0.15f, 0.095f), soilFar(0.38f, 0.30f, 0.22f);
    const float distance = std::acos(std::clamp(glm::dot(d, sun), -1.0f, 1.0f));
    if (d.y < 0) return glm::mix(soilFar, soilNear, glm::smoothstep(0.0f, 0.6f, -d.y));

    vec3 sky = glm::mix(blue, zenith, glm::smoothstep(0.1f, 0.9f, d.y));
    sky = glm::mix(horizon, sky, glm::smoothstep(0.0f, 0.35f, d.y));
    sky += 0.7f * sunlight * std::exp(-distance / 0.30f); // haze around the sun
    sky = glm::mix(sky, cloud * (0.75f + 0.8f * std::exp(-distance / 0.5f)), 0.85f * clouds(d));
    const float disc = 1.0f - glm::smoothstep(0.75f * kDiscRadius, 1.25f * kDiscRadius, distance);
    return sky + 130.0f * disc * sunlight;
}

} // namespace

Environment makeSky(int width) {
    RELUME_CHECK(width >= 2);
    Environment sky{width, width / 2, std::vector<vec3>(size_t(width) * size_t(width / 2))};
    const vec3 sun(std::sin(kSunLongitude) * std::cos(kSunElevation), std::sin(kSunElevation),
                   std::cos(kSunLongitude) * std::cos(kSunElevation));
    std::vector<vec3> columns; // directions at the horizon
    for (int x = 0; x < width; x++) columns.push_back(sky.direction(float(x) + 0.5f, float(sky.height) / 2));
    parallelFor(size_t(sky.height), [&](size_t y) {
        const vec3 row = sky.direction(float(width) / 2, float(y) + 0.5f); // at longitude 0: x is 0
        for (size_t x = 0; x < size_t(width); x++)
            sky.radiance[y * size_t(width) + x] =
                skyRadiance({columns[x].x * row.z, row.y, columns[x].z * row.z}, sun);
    });
    return sky;
}

} // namespace relume

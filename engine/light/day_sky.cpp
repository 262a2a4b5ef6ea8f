#include "engine/light/day_sky.h"

#include "engine/base/check.h"
#include "engine/light/cap.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr float kSunRadius = 0.5f * 0.53f * kPi / 180;
constexpr float kWhiteLuminance = 100 / kPi; // kcd/m² that radiance 1 stands for
constexpr float kSunIlluminance = 133;       // klx, above the atmosphere

// Returns the paper's equation 3 for Y, x and y at angles to the zenith and to the sun.
vec3 distribution(const shared::LightSky& m, float cosZenith, float toSun) {
    const float cosine = std::cos(toSun);
    return (1.0f + m.a * glm::exp(m.b / cosZenith)) *
           (1.0f + m.c * glm::exp(m.d * toSun) + m.e * cosine * cosine);
}

// Returns a chromaticity of the zenith, a polynomial in turbidity and in the sun's angle to the zenith.
float zenithChromaticity(const float (&rows)[3][4], float turbidity, float angle) {
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        float row = 0;
        for (int j = 0; j < 4; j++) row = row * angle + rows[i][j];
        sum = sum * turbidity + row;
    }
    return sum;
}

// Converts luminance Y and chromaticity (x, y) to linear sRGB.
vec3 rgbOf(vec3 Yxy) {
    const float X = Yxy.x * Yxy.y / Yxy.z, Z = Yxy.x * (1 - Yxy.y - Yxy.z) / Yxy.z;
    const vec3 rgb(3.2406f * X - 1.5372f * Yxy.x - 0.4986f * Z, -0.9689f * X + 1.8758f * Yxy.x + 0.0415f * Z,
                   0.0557f * X - 0.2040f * Yxy.x + 1.0570f * Z);
    return glm::max(rgb, vec3(0));
}

// Returns the share of sunlight that the atmosphere transmits, by Rayleigh scattering, aerosols and ozone;
// air mass by Kasten (1965).
vec3 transmittance(float elevation, float turbidity) {
    const float degrees = glm::degrees(std::max(elevation, 0.0f));
    const float mass = 1 / (std::sin(glm::radians(degrees)) + 0.15f * std::pow(degrees + 3.885f, -1.253f));
    const float beta = std::max(0.04608f * turbidity - 0.04586f, 0.0f);
    const vec3 wavelength(0.610f, 0.550f, 0.465f); // µm
    const vec3 ozone = 0.0035f * vec3(12.0f, 8.5f, 0.75f);
    const vec3 depth =
        0.008735f * glm::pow(wavelength, vec3(-4.08f)) + beta * glm::pow(wavelength, vec3(-1.3f)) + ozone;
    return glm::exp(-mass * depth);
}

// Returns the irradiance of a horizontal surface under the sky, by the midpoint rule over 16 × 64 cells of
// equal projected area.
vec3 horizontalIrradiance(const shared::LightSky& model) {
    constexpr int kRings = 16, kSectors = 64;
    vec3 sum(0);
    for (int ring = 0; ring < kRings; ring++) {
        const float squared = (float(ring) + 0.5f) / kRings, across = std::sqrt(squared);
        for (int sector = 0; sector < kSectors; sector++) {
            const float angle = 2 * kPi * (float(sector) + 0.5f) / kSectors;
            sum += skyRadiance(model,
                               {across * std::sin(angle), std::sqrt(1 - squared), across * std::cos(angle)});
        }
    }
    return sum * (kPi / (kRings * kSectors));
}

} // namespace

shared::LightSky makeSkyModel(const DaySky& sky) {
    RELUME_CHECK(sky.turbidity >= 2 && sky.turbidity <= 10 && sky.gain >= 0);
    const float T = sky.turbidity;
    const float elevation = std::asin(std::clamp(sky.sun.y, -1.0f, 1.0f));
    const float angle = kPi / 2 - std::max(elevation, 0.0f); // of the sun to the zenith
    const vec2 level = vec2(sky.sun.x, sky.sun.z);
    const float across = glm::length(level);

    shared::LightSky model{};
    model.sun = elevation >= 0 || across == 0 ? sky.sun : vec3(level.x / across, 0, level.y / across);
    model.a = vec3(0.1787f, -0.0193f, -0.0167f) * T + vec3(-1.4630f, -0.2592f, -0.2608f);
    model.b = vec3(-0.3554f, -0.0665f, -0.0950f) * T + vec3(0.4275f, 0.0008f, 0.0092f);
    model.c = vec3(-0.0227f, -0.0004f, -0.0079f) * T + vec3(5.3251f, 0.2125f, 0.2102f);
    model.d = vec3(0.1206f, -0.0641f, -0.0441f) * T + vec3(-2.5771f, -0.8989f, -1.6537f);
    model.e = vec3(-0.0670f, -0.0033f, -0.0109f) * T + vec3(0.3703f, 0.0452f, 0.0529f);

    constexpr float kX[3][4] = {{0.00166f, -0.00375f, 0.00209f, 0},
                                {-0.02903f, 0.06377f, -0.03202f, 0.00394f},
                                {0.11693f, -0.21196f, 0.06052f, 0.25886f}};
    constexpr float kY[3][4] = {{0.00275f, -0.00610f, 0.00317f, 0},
                                {-0.04214f, 0.08970f, -0.04153f, 0.00516f},
                                {0.15346f, -0.26756f, 0.06670f, 0.26688f}};
    const float chi = (4.0f / 9 - T / 120) * (kPi - 2 * angle);
    const vec3 zenith((4.0453f * T - 4.9710f) * std::tan(chi) - 0.2155f * T + 2.4192f, // kcd/m²
                      zenithChromaticity(kX, T, angle), zenithChromaticity(kY, T, angle));
    const float dusk = std::pow(10.0f, glm::degrees(std::min(elevation, 0.0f)) / 2.9f);
    model.zenith = zenith / distribution(model, 1, angle);
    model.zenith.x *= dusk * sky.gain / kWhiteLuminance;

    const Lamp sun = sunLamp(sky);
    const vec3 fromSun = sun.radiance * capSolidAngle(sun.angularRadius) * std::max(sky.sun.y, 0.0f);
    model.ground = sky.ground / kPi * (horizontalIrradiance(model) + fromSun);
    return model;
}

vec3 skyRadiance(const shared::LightSky& model, vec3 direction) {
    if (direction.y <= 0) return model.ground;
    // From the half chord, since acos() loses precision near the sun.
    const float toSun = 2 * std::asin(std::min(0.5f * glm::distance(direction, model.sun), 1.0f));
    return rgbOf(model.zenith * distribution(model, direction.y, toSun));
}

Lamp sunLamp(const DaySky& sky) {
    const float elevation = std::asin(std::clamp(sky.sun.y, -1.0f, 1.0f));
    const float above = std::clamp(0.5f + 0.5f * elevation / kSunRadius, 0.0f, 1.0f);
    const float luminance = kSunIlluminance / capSolidAngle(kSunRadius);
    return {sky.sun, kSunRadius,
            sky.hasDisc
                ? sky.gain * above * luminance / kWhiteLuminance * transmittance(elevation, sky.turbidity)
                : vec3(0)};
}

void addSky(LightCube& cube, const DaySky& sky) {
    const shared::LightSky model = makeSkyModel(sky);
    forEachTexel(cube.size, [&](int face, int x, int y, size_t texel) {
        vec3 sum(0);
        float weights = 0;
        forEachSubCell(face, x, y, cube.size, 2, [&](vec3 direction, float weight) {
            sum += weight * skyRadiance(model, glm::normalize(direction));
            weights += weight;
        });
        cube.radiance[texel] += sum / weights;
    });
}

} // namespace relume

// All light of a moment: what an image is lit by.
#pragma once

#include "engine/light/day_sky.h"
#include "engine/light/distant_light.h"
#include "engine/light/lamp.h"
#include "engine/light/stroke.h"

#include <memory>
#include <optional>

namespace relume {

// A prepared map (prepareForSampling), turned by `rotation` radians as in sampleEnvironment(), times `gain`.
// A blend of two is both of them, with gains 1 - w and w.
struct EnvironmentLight {
    std::shared_ptr<const Environment> map;
    float rotation = 0, gain = 1;
    std::shared_ptr<const Environment> picture =
        nullptr; // makePicture() of the same, for backgrounds; or null

    bool operator==(const EnvironmentLight&) const = default;
};

// Most lamps, strokes and distant lights, of each.
constexpr size_t kMostSources = 512;

// Environments and sky are summed; strokes painted over them, in their order; the sun, lamps and distant
// lights added.
struct Light {
    std::vector<EnvironmentLight> environments = {};
    std::optional<DaySky> sky = std::nullopt;
    std::vector<Stroke> strokes = {};
    std::vector<Lamp> lamps = {};
    std::vector<DistantLight> distant = {};
};

// Unit vector at an azimuth (0: +Z, 90: +X) and an elevation, in degrees.
vec3 directionAt(float azimuth, float elevation);

// All of it turned about +Y, by a positive angle from +Z towards +X.
Light turned(Light light, float angle);

// All of it `factor` times as bright, which is at least 0.
Light scaled(Light light, float factor);

// The lamps, and the sky's sun after them.
std::vector<Lamp> lampsAndSun(const Light& light);

// CPU twin of LightPass up to the transform.
LightCube sampleLight(const Light& light, int size);

} // namespace relume

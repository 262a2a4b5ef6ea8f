// All light of a moment, as a list of sources.
#pragma once

#include "engine/light/day_sky.h"
#include "engine/light/distant_light.h"
#include "engine/light/lamp.h"
#include "engine/light/stroke.h"

#include <memory>
#include <optional>

namespace relume {

// An environment: a map from prepareForSampling(), turned by `rotation` radians as in sampleEnvironment() and
// multiplied by `gain`. A blend of two is both of them, with gains 1 - w and w.
struct EnvironmentLight {
    std::shared_ptr<const Environment> map;
    float rotation = 0, gain = 1;
    std::shared_ptr<const Environment> picture = nullptr; // makePicture() of it, for backgrounds, or null

    bool operator==(const EnvironmentLight&) const = default;
};

// The most lamps, strokes and distant lights, of each kind.
constexpr size_t kMostSources = 512;

// The sources of a light. Environments and sky are summed, strokes are painted over them in order, then the
// sun, lamps and distant lights are added.
struct Light {
    std::vector<EnvironmentLight> environments = {};
    std::optional<DaySky> sky = std::nullopt;
    std::vector<Stroke> strokes = {};
    std::vector<Lamp> lamps = {};
    std::vector<DistantLight> distant = {};
};

// Returns the unit vector at an azimuth (0: +Z, 90: +X) and an elevation, in degrees.
vec3 directionAt(float azimuth, float elevation);

// Returns the light turned about +Y by `angle` radians; a positive angle turns +Z towards +X.
Light turned(Light light, float angle);

// Returns the light `factor` ≥ 0 times as bright.
Light scaled(Light light, float factor);

// Returns the lamps, followed by the sky's sun.
std::vector<Lamp> lampsAndSun(const Light& light);

// Sums the sources into a cube of `size` texels a side. CPU twin of LightPass up to the transform.
LightCube sampleLight(const Light& light, int size);

} // namespace relume

#include "apps/python/checks.h"

#include "engine/import/environment_file.h"
#include "engine/import/light_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relume::python {

namespace {

void expectColor(const char* name, vec3 color) {
    for (const float value : {color.x, color.y, color.z}) expectWithin(name, value, 0.0f, kLargestRadiance);
}

void expectFinite(const char* name, vec3 place) {
    if (!glm::all(glm::lessThan(glm::abs(place), vec3(std::numeric_limits<float>::infinity()))))
        throw UsageError(fmt::format("{}: expected coordinates that are finite", name));
}

// Returns the largest radiance of any channel.
float peakOf(const Environment& map) {
    float peak = 0;
    for (const vec3& radiance : map.radiance) peak = std::max({peak, radiance.x, radiance.y, radiance.z});
    return peak;
}

void expectDirection(vec3 direction) {
    const float length = glm::length(direction);
    if (!(length > 0 && std::isfinite(length)))
        throw UsageError("light: expected directions that are finite and not 0");
}

} // namespace

void expectSize(std::pair<int, int> size) {
    expectWithin("size", std::min(size.first, size.second), 1, 16384);
    expectWithin("size", std::max(size.first, size.second), 1, 16384);
}

void expectSamples(int samples) {
    if (samples != 1 && samples != 2 && samples != 4 && samples != 8)
        throw UsageError(fmt::format("samples: expected 1, 2, 4 or 8 a pixel, found {}", samples));
}

const std::shared_ptr<Asset>& expectAsset(const std::shared_ptr<Asset>& asset) {
    if (!asset) throw UsageError("asset: expected an Asset, found None");
    return asset;
}

const std::shared_ptr<Asset>& expectBaked(const std::shared_ptr<Asset>& asset) {
    for (const AssetPart& part : expectAsset(asset)->parts)
        for (const MaterialSet& set : part.sets)
            if (bytesOf(set.transport) == 0)
                throw UsageError("asset: is a plan, which has no transport: bake() makes one that has");
    return asset;
}

Camera checked(const Camera& camera) {
    expectFinite("eye", camera.eye);
    expectFinite("target", camera.target);
    if (!(glm::distance(camera.eye, camera.target) > 0))
        throw UsageError("eye: expected a point other than the target");
    return camera;
}

Light checked(Light light) {
    constexpr float kBrightest = 1e15f; // sums over a cube, and their squares, are finite
    float brightest = 0;
    for (const EnvironmentLight& environment : light.environments) {
        expectWithin("gain", environment.gain, 0.0f, kMostGain);
        brightest += environment.gain * peakOf(*environment.map);
    }
    expectWithin("light", brightest, 0.0f, kBrightest);
    if (light.sky) expectWithin("gain", light.sky->gain, 0.0f, kMostGain);
    for (const Stroke& stroke : light.strokes) expectColor("radiance", stroke.radiance);
    for (const Lamp& lamp : light.lamps) {
        expectDirection(lamp.direction);
        expectColor("radiance", lamp.radiance);
    }
    for (const DistantLight& distant : light.distant) {
        expectDirection(distant.direction);
        expectColor("irradiance", distant.irradiance);
    }
    const size_t most = std::max({light.strokes.size(), light.lamps.size(), light.distant.size()});
    if (most > kMostSources)
        throw UsageError(
            fmt::format("light: expected at most {} sources of a kind, found {}", kMostSources, most));
    return light;
}

} // namespace relume::python

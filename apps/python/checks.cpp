#include "apps/python/checks.h"

#include "engine/import/light_file.h"

#include <algorithm>
#include <cmath>

namespace relume::python {

namespace {

void expectColor(const char* name, vec3 color) {
    for (const float value : {color.x, color.y, color.z}) expectWithin(name, value, 0.0f, kMostRadiance);
}

void expectDirection(vec3 direction) {
    const float length = glm::length(direction);
    if (!(length > 0 && std::isfinite(length)))
        throw UsageError("light: expected directions that are finite");
}

} // namespace

void expectSize(std::pair<int, int> size) {
    expectWithin("size", std::min(size.first, size.second), 1, 16384);
    expectWithin("size", std::max(size.first, size.second), 1, 16384);
}

Camera checked(const Camera& camera) {
    for (const auto& [name, place] : {std::pair("eye", camera.eye), std::pair("target", camera.target)})
        for (const float value : {place.x, place.y, place.z})
            expectWithin(name, value, -kLargestNumber, kLargestNumber);
    if (!(glm::distance(camera.eye, camera.target) > 0))
        throw UsageError("eye: expected a point other than the target");
    expectWithin("fov", glm::degrees(camera.verticalFov), 0.999f, 170.001f);
    return camera;
}

Light checked(Light light) {
    for (const EnvironmentLight& environment : light.environments)
        expectWithin("gain", environment.gain, 0.0f, kMostGain);
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
    const size_t most =
        std::max({light.strokes.size(), light.lamps.size(), light.distant.size(), light.environments.size()});
    if (most > kMostSources)
        throw UsageError(
            fmt::format("light: expected at most {} sources of a kind, found {}", kMostSources, most));
    return light;
}

} // namespace relume::python

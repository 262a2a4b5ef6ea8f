#include "engine/light/light.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <cmath>

namespace relume {

vec3 directionAt(float azimuth, float elevation) {
    const float a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

Light turned(Light light, float angle) {
    const float cosine = std::cos(angle), sine = std::sin(angle);
    const auto turn = [&](vec3& d) { d = {cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x}; };
    for (EnvironmentLight& environment : light.environments) environment.rotation += angle;
    if (light.sky) turn(light.sky->sun);
    for (Stroke& stroke : light.strokes) turn(stroke.direction);
    for (Lamp& lamp : light.lamps) turn(lamp.direction);
    for (DistantLight& distant : light.distant) turn(distant.direction);
    return light;
}

Light scaled(Light light, float factor) {
    RELUME_CHECK(factor >= 0);
    for (EnvironmentLight& environment : light.environments) environment.gain *= factor;
    if (light.sky) light.sky->gain *= factor;
    for (Stroke& stroke : light.strokes) stroke.radiance *= factor;
    for (Lamp& lamp : light.lamps) lamp.radiance *= factor;
    for (DistantLight& distant : light.distant) distant.irradiance *= factor;
    return light;
}

std::vector<Lamp> lampsAndSun(const Light& light) {
    std::vector<Lamp> lamps = light.lamps;
    if (light.sky && light.sky->hasDisc) lamps.push_back(sunLamp(*light.sky));
    return lamps;
}

LightCube sampleLight(const Light& light, int size) {
    RELUME_CHECK(size > 0);
    LightCube cube{size, std::vector<vec3>(size_t(kCubeFaces) * size_t(size) * size_t(size), vec3(0))};
    for (const EnvironmentLight& environment : light.environments) {
        const LightCube sampled = sampleEnvironment(*environment.map, size, environment.rotation);
        for (size_t texel = 0; texel < cube.radiance.size(); texel++)
            cube.radiance[texel] += environment.gain * sampled.radiance[texel];
    }
    if (light.sky) addSky(cube, *light.sky);
    for (const Stroke& stroke : light.strokes) paintStroke(cube, stroke);
    for (const Lamp& lamp : lampsAndSun(light)) addLamp(cube, lamp);
    addDistantLights(cube, light.distant);
    return cube;
}

} // namespace relume

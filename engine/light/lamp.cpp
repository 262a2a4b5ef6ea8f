#include "engine/light/lamp.h"

#include "engine/light/cap.h"
#include "engine/math/cubemap.h"

namespace relume {

shared::LightCap makeLampCap(const Lamp& lamp, int size) {
    shared::LightCap cap = makeCap(lamp.direction, lamp.angularRadius, 0, size);
    cap.amount = capSolidAngle(lamp.angularRadius);
    cap.radiance = lamp.radiance;
    return cap;
}

void addLamp(LightCube& cube, const Lamp& lamp) {
    const shared::LightCap cap = makeLampCap(lamp, cube.size);
    std::vector<float> coverage(cube.radiance.size());
    double covered = 0;
    forEachTexel(cube.size, [&](int face, int x, int y, size_t texel) {
        coverage[texel] = capCoverage(cap, face, x, y, cube.size);
        covered += double(coverage[texel]) * double(cubeTexelSolidAngle(x, y, cube.size));
    });
    const float gain = float(double(cap.amount) / covered);
    for (size_t texel = 0; texel < coverage.size(); texel++)
        cube.radiance[texel] += coverage[texel] * gain * lamp.radiance;
}

} // namespace relume

#include "engine/light/light_cube.h"

#include "engine/base/check.h"
#include "engine/light/light_footprint.h"
#include "engine/math/cubemap.h"

namespace relume {

LightCube sampleEnvironment(const Environment& prepared, int size, float rotation) {
    RELUME_CHECK(size > 0);
    LightCube cube{size, std::vector<vec3>(size_t(kCubeFaces) * size_t(size) * size_t(size), vec3(0))};
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

} // namespace relume

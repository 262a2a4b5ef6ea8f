#include "engine/light/fill_light.h"

#include "shaders/shared/light.h"

#include <algorithm>

namespace relume {

LightCube fillOf(const LightCube& cube) {
    // In the order of the shader, whose lanes sum every kFillLanes-th texel.
    float sums[shared::kFillLanes] = {};
    for (size_t texel = 0; texel < cube.radiance.size(); texel++) {
        const vec3 radiance = cube.radiance[texel];
        sums[texel % shared::kFillLanes] += std::max({radiance.x, radiance.y, radiance.z, 0.0f});
    }
    for (size_t step = shared::kFillLanes / 2; step > 0; step /= 2)
        for (size_t lane = 0; lane < step; lane++) sums[lane] += sums[lane + step];
    const float most = sums[0] * (shared::kMostOfMean / float(cube.radiance.size()));
    LightCube fill = cube;
    for (vec3& radiance : fill.radiance) radiance = glm::min(radiance, vec3(most));
    return fill;
}

} // namespace relume

#include "engine/light/distant_light.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

struct TexelShare {
    CubeTexel texel;
    float weight;
};

// Returns texel (x, y) of a face, where x or y, not both, may be one beyond the edge: then the neighboring
// face's texel.
CubeTexel acrossEdge(int face, int x, int y, int size) {
    const auto place = [&](int i) {
        if (i < 0 || i >= size) return i < 0 ? -1.0001f : 1.0001f; // just beyond the edge
        return (2.0f * float(i) + 1.0f) / float(size) - 1.0f;
    };
    return cubeTexel(cubeDirection(face, place(x), place(y)), size);
}

std::array<TexelShare, 4> sharesOf(vec3 direction, int size) {
    const int face = cubeTexel(direction, size).face;
    const CubeFaceAxes axes = cubeFaceAxes(face);
    const vec2 uv = vec2(glm::dot(direction, axes.right), glm::dot(direction, axes.down)) /
                    glm::dot(direction, axes.forward);
    const vec2 place = glm::clamp((uv + 1.0f) * (0.5f * float(size)), 0.0f, float(size)) - 0.5f;
    const vec2 low = glm::floor(place), fraction = place - low;
    std::array<TexelShare, 4> shares;
    size_t corner = 4;
    for (size_t i = 0; i < 4; i++) {
        const ivec2 step(i % 2, i / 2), at = ivec2(low) + step;
        const auto weight = [&](int axis) { return step[axis] ? fraction[axis] : 1 - fraction[axis]; };
        const auto isBeyond = [&](int axis) { return at[axis] < 0 || at[axis] >= size; };
        shares[i].weight = weight(0) * weight(1);
        if (isBeyond(0) && isBeyond(1))
            corner = i;
        else
            shares[i].texel = acrossEdge(face, at.x, at.y, size);
    }
    if (corner < 4) {
        const float third = shares[corner].weight / 3;
        for (TexelShare& share : shares) share.weight += third;
        shares[corner] = {shares[(corner + 1) % 4].texel, 0};
    }
    return shares;
}

} // namespace

std::vector<shared::LightTap> distantTaps(std::span<const DistantLight> lights, int size) {
    RELUME_CHECK_LE(2, size);
    std::vector<shared::LightTap> taps;
    for (const DistantLight& light : lights) {
        RELUME_CHECK(glm::length(light.direction) > 0);
        for (const auto& [texel, weight] : sharesOf(light.direction, size))
            if (weight > 0)
                taps.push_back({uint32_t(cubeTexelIndex(texel.face, texel.x, texel.y, size)),
                                weight / cubeTexelSolidAngle(texel.x, texel.y, size) * light.irradiance});
    }
    std::ranges::stable_sort(taps, {}, &shared::LightTap::texel);
    size_t last = 0;
    for (size_t i = 1; i < taps.size(); i++) {
        if (taps[i].texel == taps[last].texel)
            taps[last].radiance += taps[i].radiance;
        else
            taps[++last] = taps[i];
    }
    if (!taps.empty()) taps.resize(last + 1);
    return taps;
}

void addDistantLights(LightCube& cube, std::span<const DistantLight> lights) {
    for (const auto& [texel, radiance] : distantTaps(lights, cube.size)) cube.radiance[texel] += radiance;
}

} // namespace relume

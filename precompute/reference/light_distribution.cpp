#include "precompute/reference/light_distribution.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>

namespace relume {

LightDistribution::LightDistribution(const LightCube& light) : mSize(light.size) {
    const auto size = size_t(mSize), texels = kCubeFaces * size * size;
    RELUME_CHECK_EQ(light.radiance.size(), texels);
    double sum = 0;
    for (size_t i = 0; i < texels; i++) {
        const vec3 radiance = light.radiance[i];
        const float solidAngle = cubeTexelSolidAngle(int(i % size), int(i / size % size), mSize);
        mTexels.push_back({radiance});
        const vec3 magnitude = glm::abs(radiance);
        mEnds.push_back(sum += double((magnitude.x + magnitude.y + magnitude.z) * solidAngle));
    }
    if (!(sum > 0)) {
        mEnds.clear();
        return;
    }
    double last = 0;
    for (size_t i = 0; i < texels; i++) {
        mEnds[i] /= sum;
        mTexels[i].density = float((mEnds[i] - last) * double(size * size) / 4);
        last = mEnds[i];
    }
    size_t texel = 0;
    for (size_t i = 0; i < texels; i++) {
        while (mEnds[texel] <= double(i) / double(texels)) texel++;
        mFirst.push_back(uint32_t(texel));
    }
}

LightDistribution::Draw LightDistribution::draw(double choice, float across, float down) const {
    size_t texel = mFirst[size_t(choice * double(mFirst.size()))];
    while (mEnds[texel] <= choice) texel++;
    const int x = int(texel) % mSize, y = int(texel) / mSize % mSize;
    const float u = 2 * (float(x) + across) / float(mSize) - 1, v = 2 * (float(y) + down) / float(mSize) - 1;
    return {glm::normalize(cubeDirection(int(texel) / (mSize * mSize), u, v)), texel};
}

float LightDistribution::density(vec3 direction, size_t texel) const {
    // dA / dω at a point of a face at unit depth is the cube of the point's distance.
    const vec3 m = glm::abs(direction);
    const float depth = std::max({m.x, m.y, m.z});
    return mTexels[texel].density / (depth * depth * depth);
}

size_t LightDistribution::texelOf(vec3 direction) const {
    const auto [face, x, y] = cubeTexel(direction, mSize);
    return size_t(cubeTexelIndex(face, x, y, mSize));
}

} // namespace relume

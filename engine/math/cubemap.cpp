#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

CubeFaceAxes cubeFaceAxes(int face) {
    switch (face) {
    case 0:
        return {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}};
    case 1:
        return {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}};
    case 2:
        return {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    case 3:
        return {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
    case 4:
        return {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    default:
        return {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    }
}

vec3 cubeDirection(int face, float u, float v) {
    const CubeFaceAxes axes = cubeFaceAxes(face);
    return axes.forward + u * axes.right + v * axes.down;
}

namespace {

float texelCenter(int x, int size) { return (2.0f * float(x) + 1.0f) / float(size) - 1.0f; }

} // namespace

vec3 cubeTexelDirection(int face, int x, int y, int size) {
    return glm::normalize(cubeDirection(face, texelCenter(x, size), texelCenter(y, size)));
}

float cubeTexelSolidAngle(int x, int y, int size) {
    const float u = texelCenter(x, size), v = texelCenter(y, size);
    const float squared = 1.0f + u * u + v * v;
    return 4.0f / (float(size) * float(size) * squared * std::sqrt(squared));
}

CubeTexel cubeTexel(vec3 direction, int size) {
    const vec3 magnitude = glm::abs(direction);
    int face;
    if (magnitude.x >= magnitude.y && magnitude.x >= magnitude.z)
        face = direction.x >= 0 ? 0 : 1;
    else if (magnitude.y >= magnitude.z)
        face = direction.y >= 0 ? 2 : 3;
    else
        face = direction.z >= 0 ? 4 : 5;
    const CubeFaceAxes axes = cubeFaceAxes(face);
    const float depth = glm::dot(direction, axes.forward);
    const auto texel = [&](float coordinate) {
        return std::clamp(int((coordinate / depth + 1.0f) * 0.5f * float(size)), 0, size - 1);
    };
    return {face, texel(glm::dot(direction, axes.right)), texel(glm::dot(direction, axes.down))};
}

} // namespace relume

#include "engine/render/view_grid.h"

#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr auto kCells = int(shared::kGridCells), kSide = int(shared::kGridSide);

struct GridPlace {
    int face;
    vec2 place; // position in cells
};

GridPlace placeOf(vec3 direction) {
    const int face = cubeTexel(direction, 1).face;
    const CubeFaceAxes axes = cubeFaceAxes(face);
    const float depth = glm::dot(direction, axes.forward);
    const auto cells = [&](vec3 axis) {
        const float angle = std::atan(glm::dot(direction, axis) / depth);
        return std::clamp((angle / (kPi / 2) + 0.5f) * float(kCells), 0.0f, float(kCells));
    };
    return {face, {cells(axes.right), cells(axes.down)}};
}

uint32_t nodeAt(int face, int x, int y) { return uint32_t((face * kSide + y) * kSide + x); }

} // namespace

vec3 gridDirection(uint32_t node) {
    const int x = int(node) % kSide, y = int(node) / kSide % kSide, face = int(node) / (kSide * kSide);
    const auto coordinate = [](int corner) {
        return std::tan((float(corner) / float(kCells) - 0.5f) * (kPi / 2));
    };
    return glm::normalize(cubeDirection(face, coordinate(x), coordinate(y)));
}

GridCell gridCell(vec3 direction) {
    const auto [face, place] = placeOf(direction);
    const ivec2 low = glm::min(ivec2(place), ivec2(kCells - 1));
    return {{nodeAt(face, low.x, low.y), nodeAt(face, low.x + 1, low.y), nodeAt(face, low.x, low.y + 1),
             nodeAt(face, low.x + 1, low.y + 1)},
            place - vec2(low)};
}

void addGridNodes(std::set<uint32_t>& nodes, vec3 corner, vec3 right, vec3 down, vec2 leftTop,
                  vec2 rightBottom) {
    // Sampled directions are less than a cell apart, so that cells between two of them are next to theirs.
    constexpr int kSteps = 24;
    constexpr float kReach = 0.5f; // in cells
    const vec2 step = (rightBottom - leftTop) / float(kSteps);
    for (int j = 0; j <= kSteps; j++)
        for (int i = 0; i <= kSteps; i++) {
            const vec2 pixel = leftTop + vec2(float(i), float(j)) * step;
            const auto [face, place] = placeOf(-(corner + pixel.x * right + pixel.y * down));
            const ivec2 low = glm::clamp(ivec2(glm::floor(place - kReach)), ivec2(0), ivec2(kCells));
            const ivec2 high = glm::clamp(ivec2(glm::ceil(place + kReach)), ivec2(0), ivec2(kCells));
            for (int y = low.y; y <= high.y; y++)
                for (int x = low.x; x <= high.x; x++) nodes.insert(nodeAt(face, x, y));
        }
}

} // namespace relume

#include "engine/light/cap.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Sub-cells per radius of a disc, and their bounds per side of a texel. With four, and edges one sub-cell
// wide, a texel's coverage errs by less than 1 % of the disc.
constexpr float kCellsPerRadius = 4;
constexpr int kFewestCells = 4, kMostCells = 16;

} // namespace

float chord(float angle) { return 2 * std::sin(angle / 2); }

shared::LightCap makeCap(vec3 direction, float angularRadius, float softness, int size) {
    RELUME_CHECK(glm::length(direction) > 0 && size > 0);
    RELUME_CHECK(angularRadius > 0 && angularRadius <= kPi && softness >= 0 && softness <= 1);
    const float texel = 2.0f / float(size);
    const float radius = std::max(angularRadius, texel * kCellsPerRadius / float(kMostCells));
    shared::LightCap cap{};
    const vec3 center = glm::normalize(direction);
    for (int face = 0; face < kCubeFaces; face++) {
        const CubeFaceAxes axes = cubeFaceAxes(face);
        cap.centers[face] = {glm::dot(center, axes.right), glm::dot(center, axes.down),
                             glm::dot(center, axes.forward)};
    }
    cap.side =
        uint32_t(std::clamp(int(std::ceil(kCellsPerRadius * texel / radius)), kFewestCells, kMostCells));
    const float edge = texel / float(cap.side);
    cap.inner = chord(radius * (1 - softness)) - edge / 2;
    cap.outer = chord(radius) + edge / 2;
    return cap;
}

float capCoverage(const shared::LightCap& cap, int face, int x, int y, int size) {
    const vec3 center = cap.centers[face];
    const auto local = [](float u, float v) { return glm::normalize(vec3(u, v, 1)); };
    const auto middle = [&](int i) { return (2.0f * float(i) + 1.0f) / float(size) - 1.0f; };
    // No point of a texel is further from its center, since projection to the sphere shortens distances.
    const float reach = std::sqrt(2.0f) / float(size);
    const float away = glm::distance(local(middle(x), middle(y)), center);
    if (away - reach >= cap.outer) return 0;
    if (away + reach <= cap.inner) return 1;
    float covered = 0, weights = 0;
    forEachSubCellPlace(x, y, size, int(cap.side), [&](float u, float v, float weight) {
        const float within = (cap.outer - glm::distance(local(u, v), center)) / (cap.outer - cap.inner);
        covered += weight * std::clamp(within, 0.0f, 1.0f);
        weights += weight;
    });
    return covered / weights;
}

float capSolidAngle(float angularRadius) {
    const float half = std::sin(angularRadius / 2);
    return 4 * kPi * half * half;
}

} // namespace relume

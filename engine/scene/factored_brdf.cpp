#include "engine/scene/factored_brdf.h"

#include <algorithm>
#include <cmath>

namespace relume {

vec3 lookupMap(const vec3* map, int size, DiskMapping mapping, vec3 local) {
    const vec2 place = diskMapCoordinates(mapping, local) * float(size) - 0.5f;
    const vec2 corner = glm::floor(place);
    const vec2 weight = place - corner;
    const auto column = [&](int x) {
        return mapping == DiskMapping::Polar ? (x + size) % size : std::clamp(x, 0, size - 1);
    };
    const int x0 = column(int(corner.x)), x1 = column(int(corner.x) + 1);
    const int y0 = std::clamp(int(corner.y), 0, size - 1), y1 = std::clamp(int(corner.y) + 1, 0, size - 1);
    const vec3 top = glm::mix(map[y0 * size + x0], map[y0 * size + x1], weight.x);
    const vec3 bottom = glm::mix(map[y1 * size + x0], map[y1 * size + x1], weight.x);
    return glm::mix(top, bottom, weight.y);
}

vec3 evaluate(const FactoredBrdf& brdf, vec3 incoming, vec3 outgoing, int layer) {
    vec3 sum(0);
    for (int term = 0; term < brdf.terms; term++)
        sum += lookupMap(brdf.lightMap(term), brdf.size, brdf.mapping, incoming) *
               lookupMap(brdf.viewMap(layer, term), brdf.size, brdf.mapping, outgoing);
    return sum;
}

} // namespace relume

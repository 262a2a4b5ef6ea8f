#include "engine/scene/factored_brdf.h"

#include <algorithm>
#include <cmath>

namespace relume {

MapPlace placeInMap(int size, DiskMapping mapping, vec3 local) {
    const vec2 place = diskMapCoordinates(mapping, local) * float(size) - 0.5f;
    const vec2 corner = glm::floor(place);
    const auto column = [&](int x) {
        return isPolar(mapping) ? (x + size) % size : std::clamp(x, 0, size - 1);
    };
    const int x0 = column(int(corner.x)), x1 = column(int(corner.x) + 1);
    const int y0 = std::clamp(int(corner.y), 0, size - 1), y1 = std::clamp(int(corner.y) + 1, 0, size - 1);
    return {{y0 * size + x0, y0 * size + x1, y1 * size + x0, y1 * size + x1}, place - corner};
}

vec3 lookupMap(const vec3* map, const MapPlace& place) {
    const auto& [topLeft, topRight, bottomLeft, bottomRight] = place.texels;
    const vec3 top = glm::mix(map[topLeft], map[topRight], place.weight.x);
    const vec3 bottom = glm::mix(map[bottomLeft], map[bottomRight], place.weight.x);
    return glm::mix(top, bottom, place.weight.y);
}

vec3 lookupMap(const vec3* map, int size, DiskMapping mapping, vec3 local) {
    return lookupMap(map, placeInMap(size, mapping, local));
}

vec3 evaluate(const FactoredBrdf& brdf, vec3 incoming, vec3 outgoing, int layer) {
    const MapPlace light = placeInMap(brdf.size, brdf.mapping, incoming);
    const MapPlace view = placeInMap(brdf.size, brdf.mapping, outgoing);
    vec3 sum(0);
    for (int term = 0; term < brdf.terms; term++)
        sum += lookupMap(brdf.lightMap(term), light) * lookupMap(brdf.viewMap(layer, term), view);
    return sum;
}

bool isNonnegative(const FactoredBrdf& brdf) {
    const auto isAtLeastZero = [](vec3 v) { return v.x >= 0 && v.y >= 0 && v.z >= 0; };
    return std::ranges::all_of(brdf.lightMaps, isAtLeastZero) &&
           std::ranges::all_of(brdf.viewMaps, isAtLeastZero);
}

} // namespace relume

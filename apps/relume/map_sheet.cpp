#include "apps/relume/map_sheet.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr int kColumns = 4, kRows = 2, kLeastMapPixels = 192, kLeastTexelPixels = 4, kMargin = 8;
constexpr vec3 kBackground(0.13f), kNegative(1, 0.15f, 0.85f);

float largestMagnitude(const vec3* map, size_t texels) {
    float largest = 0;
    for (size_t i = 0; i < texels; i++) {
        const vec3 size = glm::abs(map[i]);
        largest = std::max({largest, size.x, size.y, size.z});
    }
    return largest;
}

// Returns the color of a value in [-1, 1], gamma-encoded for display; negative ones in the color kNegative.
vec3 colorOf(vec3 value) {
    const vec3 bright = glm::pow(glm::abs(value), vec3(1 / 2.2f));
    if (value.x + value.y + value.z >= 0) return bright;
    return kNegative * std::max({bright.x, bright.y, bright.z});
}

} // namespace

Image drawMapSheet(const FactoredBrdf& brdf) {
    const int scale = std::max(kLeastTexelPixels, kLeastMapPixels / brdf.size), side = scale * brdf.size;
    Image sheet(kColumns * side + (kColumns + 1) * kMargin, kRows * side + (kRows + 1) * kMargin);
    std::fill(sheet.pixels.begin(), sheet.pixels.end(), vec4(kBackground, 1));
    for (int term = 0; term < std::min(brdf.terms, kColumns * kRows); term++) {
        const vec3* map = brdf.lightMap(term);
        const float largest = largestMagnitude(map, brdf.mapTexels());
        const int left = kMargin + term % kColumns * (side + kMargin),
                  top = kMargin + term / kColumns * (side + kMargin);
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const ivec2 texel(x / scale, brdf.size - 1 - y / scale);
                const vec2 center = (vec2(texel) + 0.5f) / float(brdf.size);
                if (!diskMapDirection(brdf.mapping, center) || largest == 0) continue;
                const vec3 value = map[texel.y * brdf.size + texel.x] / largest;
                sheet.at(left + x, top + y) = vec4(colorOf(value), 1);
            }
    }
    return sheet;
}

} // namespace relume

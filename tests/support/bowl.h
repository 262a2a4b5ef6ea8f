// A concave scene with closed forms.
#pragma once

#include "engine/scene/mesh.h"

#include <cmath>

namespace relume::test {

// The inside of the lower half of the unit sphere. From each of its points the cosine-weighted half of all
// directions ends on it, whatever the point: light that comes evenly from above the rim is lit again and
// again by the same share, so that a diffuse bowl of albedo ρ under radiance 1 has ρ/2 / (1 - ρ/2)
// everywhere.
inline Mesh makeBowl(uint32_t columns = 48, uint32_t rows = 24) {
    Mesh bowl;
    const auto add = [&](float angle, float turn) {
        const vec3 p(std::sin(angle) * std::cos(turn), -std::cos(angle), std::sin(angle) * std::sin(turn));
        bowl.positions.push_back(p);
        bowl.normals.push_back(-p);
    };
    add(0, 0);
    for (uint32_t row = 1; row <= rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            add(kPi / 2 * float(row) / float(rows), 2 * kPi * float(column) / float(columns));
    const auto at = [&](uint32_t row, uint32_t column) {
        return row == 0 ? 0 : 1 + (row - 1) * columns + column % columns;
    };
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            const uint32_t a = at(row, column), b = at(row, column + 1), c = at(row + 1, column),
                           d = at(row + 1, column + 1);
            if (row > 0) bowl.triangles.push_back({a, b, d});
            bowl.triangles.push_back({a, d, c});
        }
    return bowl;
}

} // namespace relume::test

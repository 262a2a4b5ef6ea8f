// Sub-cells of the lighting cube's texels: internal to engine/light.
#pragma once

#include "engine/math/cubemap.h"

#include <cmath>

namespace relume {

// Visits the centers (u, v) of count × count equal squares of a texel, row by row, with a weight proportional
// to their solid angle.
template <typename Visit>
void forEachSubCellPlace(int x, int y, int size, int count, Visit visit) {
    const auto center = [&](int texel, int sub) {
        return 2.0f * (float(texel) + (float(sub) + 0.5f) / float(count)) / float(size) - 1.0f;
    };
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++) {
            const float u = center(x, i), v = center(y, j);
            const float squared = 1.0f + u * u + v * v;
            visit(u, v, 1.0f / (squared * std::sqrt(squared)));
        }
}

// Visits the same centers as unnormalized directions instead of (u, v).
template <typename Visit>
void forEachSubCell(int face, int x, int y, int size, int count, Visit visit) {
    forEachSubCellPlace(x, y, size, count,
                        [&](float u, float v, float weight) { visit(cubeDirection(face, u, v), weight); });
}

// Visits all texels of a cube in the order of their indices.
template <typename Visit>
void forEachTexel(int size, Visit visit) {
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) visit(face, x, y, size_t(cubeTexelIndex(face, x, y, size)));
}

} // namespace relume

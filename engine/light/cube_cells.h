// Sub-cells of the lighting cube's texels: internal to engine/light.
#pragma once

#include "engine/math/cubemap.h"

#include <cmath>

namespace relume {

// Visits the centres of count × count equal squares (in u and v) of a texel, row by row, with their
// unnormalised direction and a weight in proportion to their solid angle.
template <typename Visit>
void forEachSubCell(int face, int x, int y, int size, int count, Visit visit) {
    const auto centre = [&](int texel, int sub) {
        return 2.0f * (float(texel) + (float(sub) + 0.5f) / float(count)) / float(size) - 1.0f;
    };
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++) {
            const float u = centre(x, i), v = centre(y, j);
            const float squared = 1.0f + u * u + v * v;
            visit(cubeDirection(face, u, v), 1.0f / (squared * std::sqrt(squared)));
        }
}

} // namespace relume

// Directions on a cube: Vulkan's cubemap faces and axes. GLSL twin: shaders/lib/cubemap.glsl.
//
// Faces 0 to 5 look along +X, -X, +Y, -Y, +Z, -Z (Vulkan 1.3 specification, table "Cube map face
// selection"). On a face, u runs right and v down, both in [-1, 1]; texel (x, y) of a face of
// `size` texels is centered at u = (2x + 1) / size - 1, v likewise.
#pragma once

#include "engine/math/vector.h"

#include <cmath>

namespace relume {

constexpr int kCubeFaces = 6;

// The three axes of a face in the world. The direction of (u, v) is forward + u · right + v · down.
struct CubeFaceAxes {
    vec3 right, down, forward;
};

// Returns the axes of `face`, 0 to 5.
CubeFaceAxes cubeFaceAxes(int face);

// Returns the direction of face coordinates (u, v), not normalized; its length is √(1 + u² + v²).
vec3 cubeDirection(int face, float u, float v);

// Returns the unit direction through the center of a texel.
vec3 cubeTexelDirection(int face, int x, int y, int size);

// Returns the solid angle of a texel by the midpoint rule, 4 / (size² (1 + u² + v²)^(3/2)), in steradians.
// Over a cube it sums to 4π within 1e-4 for size ≥ 64.
float cubeTexelSolidAngle(int x, int y, int size);

// A texel of a cube map.
struct CubeTexel {
    int face, x, y;
};

// Returns the texel that a direction of any length but zero passes through; faces have `size` texels a side.
CubeTexel cubeTexel(vec3 direction, int size);

// Returns the index of a texel in an array of six faces, row by row: face·size² + y·size + x.
inline int cubeTexelIndex(int face, int x, int y, int size) { return (face * size + y) * size + x; }

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

// Directions on a cube: Vulkan's cubemap faces and axes. GLSL twin: shaders/lib/cubemap.glsl.
//
// Faces 0 to 5 look along +X, -X, +Y, -Y, +Z, -Z (Vulkan 1.3 specification, table "Cube map face
// selection"). On a face, u runs right and v down, both in [-1, 1]; texel (x, y) of a face of
// `size` texels is centered at u = (2x + 1) / size - 1, v likewise.
#pragma once

#include "engine/math/vector.h"

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

} // namespace relume

// Directions on a cube. C++ twin: engine/math/cubemap.h.
#ifndef RELUME_LIB_CUBEMAP_GLSL
#define RELUME_LIB_CUBEMAP_GLSL

// The axes of each face. Columns are right, down and forward, so that `v * axes` gives v's face coordinates.
const mat3 kFaceAxes[6] = mat3[6](
    mat3(vec3(0, 0, -1), vec3(0, -1, 0), vec3(1, 0, 0)),
    mat3(vec3(0, 0, 1), vec3(0, -1, 0), vec3(-1, 0, 0)),
    mat3(vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)),
    mat3(vec3(1, 0, 0), vec3(0, 0, -1), vec3(0, -1, 0)),
    mat3(vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1)),
    mat3(vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)));

// Returns the unnormalized direction of face coordinates u (right) and v (down), both in [-1, 1].
vec3 cubeDirection(uint face, vec2 uv) { return kFaceAxes[face] * vec3(uv, 1); }

// Returns the face that a direction of any length but zero passes through.
uint cubeFace(vec3 direction) {
    const vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z) return direction.x >= 0 ? 0 : 1;
    if (size.y >= size.z) return direction.y >= 0 ? 2 : 3;
    return direction.z >= 0 ? 4 : 5;
}

// Returns the u and v of a direction on that face.
vec2 cubeCoordinates(uint face, vec3 direction) {
    const vec3 local = direction * kFaceAxes[face];
    return local.xy / local.z;
}

// Returns the solid angle, in sr, of a square of side `width` (in units of u and v) at uv, by the midpoint rule.
float cubeSolidAngle(vec2 uv, float width) {
    const float squared = 1 + dot(uv, uv);
    return width * width / (squared * sqrt(squared));
}

#endif

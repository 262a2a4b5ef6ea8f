// Tangent frames from normals and tangents. C++ twin: engine/math/tangent_frame.h.
#ifndef RELUME_LIB_TANGENT_FRAME_GLSL
#define RELUME_LIB_TANGENT_FRAME_GLSL

// Returns the frame of a normal, with rows s, t, n: `frame * world` gives local coordinates.
mat3 tangentFrame(vec3 n) {
    const float above = n.y + 1;
    const vec3 tangent = vec3(above * above + n.z * n.z - n.x * n.x, -2 * n.x * above, -2 * n.x * n.z);
    const float squared = dot(tangent, tangent);
    vec3 s = squared > 1e-10 ? tangent / sqrt(squared) : vec3(1, 0, 0);
    s = normalize(s - dot(s, n) * n);
    return transpose(mat3(s, cross(n, s), n));
}

// Returns the frame whose s is the part of `tangent` orthogonal to the normal, or the normal's frame if this
// vanishes.
mat3 tangentFrame(vec3 n, vec3 tangent) {
    const vec3 along = tangent - dot(tangent, n) * n;
    const float squared = dot(along, along);
    if (!(squared > 1e-10)) return tangentFrame(n);
    const vec3 s = along / sqrt(squared);
    return transpose(mat3(s, cross(n, s), n));
}

// Returns the mirror image of the normal's frame in the plane y = 0: smooth except at n = (0, 1, 0).
mat3 lowerTangentFrame(vec3 n) {
    const vec3 mirror = vec3(1, -1, 1);
    return tangentFrame(n, mirror * (vec3(1, 0, 0) * tangentFrame(mirror * n)));
}

#endif

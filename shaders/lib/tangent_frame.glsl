// Tangent frames from normals. C++ twin: engine/math/tangent_frame.h.
#ifndef RELUME_LIB_TANGENT_FRAME_GLSL
#define RELUME_LIB_TANGENT_FRAME_GLSL

// Rows s, t, n: `frame * world` gives local coordinates.
mat3 tangentFrame(vec3 n) {
    const float above = n.y + 1;
    const vec3 tangent = vec3(above * above + n.z * n.z - n.x * n.x, -2 * n.x * above, -2 * n.x * n.z);
    const float squared = dot(tangent, tangent);
    vec3 s = squared > 1e-10 ? tangent / sqrt(squared) : vec3(1, 0, 0);
    s = normalize(s - dot(s, n) * n);
    return transpose(mat3(s, cross(n, s), n));
}

#endif

// Intersection of a ray with a triangle's plane. Its C++ twin is Embree, in precompute/visibility/ray_tracer.h.
#ifndef RELUME_SHADERS_LIB_BARYCENTRIC_GLSL
#define RELUME_SHADERS_LIB_BARYCENTRIC_GLSL

// Returns the intersection's barycentric weights (Möller and Trumbore 1997); outside the triangle some are negative.
vec3 barycentricWeights(vec3 eye, vec3 direction, vec3 corners[3]) {
    const vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], s = eye - corners[0];
    const vec3 p = cross(direction, e2), q = cross(s, e1);
    const float determinant = dot(e1, p), scale = determinant != 0 ? 1 / determinant : 0;
    const vec2 yz = vec2(dot(s, p), dot(direction, q)) * scale;
    return vec3(1 - yz.x - yz.y, yz);
}

// Returns the derivative of the barycentric weights as the ray's direction changes by `step`.
vec3 barycentricSlopes(vec3 eye, vec3 direction, vec3 corners[3], vec3 step, vec3 weights) {
    const vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], s = eye - corners[0];
    const vec3 p = cross(step, e2), q = cross(s, e1);
    const float determinant = dot(e1, cross(direction, e2)), scale = determinant != 0 ? 1 / determinant : 0;
    const vec2 yz = (vec2(dot(s, p), dot(step, q)) - weights.yz * dot(e1, p)) * scale;
    return vec3(-yz.x - yz.y, yz);
}
#endif

// Normal mapping in axes that follow from the triangle's texture coordinates. C++ twin:
// engine/scene/surface_detail.h.
#ifndef RELUME_LIB_NORMAL_MAP_GLSL
#define RELUME_LIB_NORMAL_MAP_GLSL

// Returns a mapped normal, turned towards the eye if it would face away from it. C++ twin:
// precompute/reference/bound_asset.cpp.
vec3 facingNormal(vec3 normal, vec3 view) {
    const float kLeastCosine = 0.05;
    return normalize(normal + max(kLeastCosine - dot(normal, view), 0) * view);
}

vec3 mappedNormal(vec3 normal, vec3 place[3], vec2 uv[3], vec3 mapped) {
    const vec3 a = place[1] - place[0], b = place[2] - place[0];
    const vec2 u = uv[1] - uv[0], v = uv[2] - uv[0];
    const float area = u.x * v.y - v.x * u.y;
    const vec3 right = (v.y * a - u.y * b) * (area < 0 ? -1 : 1);
    const vec3 up = (v.x * a - u.x * b) * (area < 0 ? -1 : 1); // against v, which goes down
    const vec3 s = right - dot(right, normal) * normal;
    const float size = length(s);
    if (!(size > 0) || area == 0) return normal;
    const vec3 side = cross(normal, s / size);
    const vec3 t = dot(side, up) < 0 ? -side : side;
    const vec3 found = mapped.x * (s / size) + mapped.y * t + mapped.z * normal;
    return dot(found, found) > 0 ? normalize(found) : normal;
}

#endif

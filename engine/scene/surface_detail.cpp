#include "engine/scene/surface_detail.h"

namespace relume {

vec3 mappedNormal(vec3 normal, const Mesh& mesh, const uvec3& corners, vec3 mapped) {
    const vec3 origin = mesh.positions[corners.x];
    const vec3 a = mesh.positions[corners.y] - origin, b = mesh.positions[corners.z] - origin;
    const vec2 u = mesh.uvs[corners.y] - mesh.uvs[corners.x], v = mesh.uvs[corners.z] - mesh.uvs[corners.x];
    const float area = u.x * v.y - v.x * u.y;
    const vec3 right = (v.y * a - u.y * b) * (area < 0 ? -1.0f : 1.0f);
    const vec3 up = (v.x * a - u.x * b) * (area < 0 ? -1.0f : 1.0f); // against v, which points down
    const vec3 s = right - glm::dot(right, normal) * normal;
    const float length = glm::length(s);
    if (!(length > 0) || area == 0) return normal;
    const vec3 side = glm::cross(normal, s / length);
    const vec3 t = glm::dot(side, up) < 0 ? -side : side;
    const vec3 found = mapped.x * (s / length) + mapped.y * t + mapped.z * normal;
    return glm::dot(found, found) > 0 ? glm::normalize(found) : normal;
}

vec3 detailedNormal(const SurfaceDetail& detail, vec3 normal, const Mesh& mesh, const uvec3& corners,
                    vec2 uv) {
    if (!detail.normalMap || detail.normalScale == 0) return normal;
    const vec3 mapped = 2.0f * vec3(sample(*detail.normalMap, uv)) - 1.0f;
    return mappedNormal(normal, mesh, corners, mapped * vec3(detail.normalScale, detail.normalScale, 1));
}

vec3 emittedRadiance(const SurfaceDetail& detail, vec2 uv) {
    return detail.emissionMap ? detail.emission * vec3(sample(*detail.emissionMap, uv)) : detail.emission;
}

} // namespace relume

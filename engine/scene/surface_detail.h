// Surface detail that is drawn per pixel and does not enter transport.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/scene/texture.h"

#include <optional>

namespace relume {

// A normal map and an emission.
struct SurfaceDetail {
    // A tangent-space normal map, sampled at mesh.uvs: a normal is 2 texel - 1, linear. As in glTF, x points
    // right in the image, y up, z away from the surface.
    std::optional<Texture> normalMap = std::nullopt;
    float normalScale = 1; // multiplies x and y of mapped normals
    // Radiance emitted in all directions, and an image, sampled at mesh.uvs, that multiplies it.
    vec3 emission = vec3(0);
    std::optional<Texture> emissionMap = std::nullopt;

    bool usesUvs() const { return normalMap || emissionMap; }
    bool isAny() const { return usesUvs() || emission != vec3(0); }
};

constexpr float kLargestEmission = 1e6f, kLargestNormalScale = 100; // the scale may have either sign

// Returns the surface normal for a normal-map value `mapped`, in axes that follow from the triangle's texture
// coordinates (Schüler, "Followup: Normal Mapping Without Precomputed Tangents", 2013). Returns `normal`,
// which is unit, if the triangle has no area in the image. GLSL twin: shaders/lib/normal_map.glsl.
vec3 mappedNormal(vec3 normal, const Mesh& mesh, const uvec3& corners, vec3 mapped);

// Returns the unit normal at a point of a triangle after normal mapping; `normal` is the interpolated one.
vec3 detailedNormal(const SurfaceDetail& detail, vec3 normal, const Mesh& mesh, const uvec3& corners,
                    vec2 uv);

// Returns the radiance emitted at texture coordinates uv.
vec3 emittedRadiance(const SurfaceDetail& detail, vec2 uv);

} // namespace relume

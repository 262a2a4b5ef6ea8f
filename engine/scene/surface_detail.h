// Details of a surface that are drawn pixel by pixel, and of which its transport knows nothing.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/scene/texture.h"

#include <optional>

namespace relume {

struct SurfaceDetail {
    // By mesh.uvs: a normal in [-1, 1]³ as 2 texel - 1, linear. x points right in the image, y up, z away
    // from the surface, as in glTF.
    std::optional<Texture> normalMap = std::nullopt;
    float normalScale = 1; // of its x and y
    // Radiance that leaves the surface in all directions, and an image by mesh.uvs that multiplies it.
    vec3 emission = vec3(0);
    std::optional<Texture> emissionMap = std::nullopt;

    bool usesUvs() const { return normalMap || emissionMap; }
    bool isAny() const { return usesUvs() || emission != vec3(0); }
};

constexpr float kLargestEmission = 1e6f, kLargestNormalScale = 100; // the latter either way

// Returns the surface's normal where a normal map says `mapped`, in axes that follow from the triangle's
// texture coordinates (Schüler, "Followup: Normal Mapping Without Precomputed Tangents", 2013). `normal` is
// unit, and is returned where the triangle has no area in the image. GLSL twin: shaders/lib/normal_map.glsl.
vec3 mappedNormal(vec3 normal, const Mesh& mesh, const uvec3& corners, vec3 mapped);

// Returns the unit normal that the detail gives a point of a triangle, from that which is interpolated.
vec3 detailedNormal(const SurfaceDetail& detail, vec3 normal, const Mesh& mesh, const uvec3& corners,
                    vec2 uv);

// Returns the radiance that leaves the surface at a place in its images.
vec3 emittedRadiance(const SurfaceDetail& detail, vec2 uv);

} // namespace relume

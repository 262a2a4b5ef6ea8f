// Assets small enough to build inside a test.
#pragma once

#include "engine/transport/asset.h"

#include <fmt/core.h>

namespace relume::test {

// One term of constant maps: light map 1, view map albedo / π, which is a diffuse BRDF.
inline FactoredBrdf makeDiffuseFactors(vec3 albedo, int size = 8) {
    FactoredBrdf brdf;
    brdf.size = size;
    brdf.terms = 1;
    brdf.lightMaps.assign(brdf.mapTexels(), vec3(1));
    brdf.viewMaps.assign(brdf.mapTexels(), albedo / kPi);
    brdf.eigenvalues = {{albedo.x, albedo.y, albedo.z}};
    return brdf;
}

// A part with those factors, a material that says the same, and no transport.
inline AssetPart makeDiffusePart(const Mesh& mesh, float albedo) {
    AssetPart part;
    part.mesh = mesh;
    part.sets.push_back({{{"diffuse", fmt::format(R"({{"model": "diffuse", "albedo": {0}}})", albedo)}},
                         makeDiffuseFactors(vec3(albedo)),
                         {}});
    return part;
}

// An asset of these parts whose occluder is all their triangles.
inline Asset makeTestAsset(std::vector<AssetPart> parts) {
    Asset asset;
    for (const AssetPart& part : parts) append(asset.occluder, part.mesh);
    asset.visibilityOffset = 1e-3f;
    asset.parts = std::move(parts);
    return asset;
}

// A quad from three of its corners, counter-clockwise: corner, corner + a, corner + a + b, corner + b;
// normals a × b.
inline Mesh makeQuad(vec3 corner, vec3 a, vec3 b) {
    return {{corner, corner + a, corner + a + b, corner + b},
            std::vector<vec3>(4, glm::normalize(glm::cross(a, b))),
            {{0, 1, 2}, {0, 2, 3}}};
}

} // namespace relume::test

#include "apps/viewer/model.h"

#include "precompute/reference/bound_asset.h"

#include <algorithm>
#include <utility>

namespace relume {

Model::Model(const vk::Device& device, const std::filesystem::path& path)
    : Model(device, path, readAsset(path), false) {}

Model::Model(const vk::Device& device, const std::filesystem::path& path, Asset sketch)
    : Model(device, path, std::move(sketch), true) {}

Model::Model(const vk::Device& device, const std::filesystem::path& path, Asset whole, bool isUnshadowed)
    : file(path), isSketch(isUnshadowed), asset(std::move(whole)), bounds(objectBounds(asset)),
      groundFade(makeGroundFade(asset, GroundStyle::Shadow)), appearance(defaultAppearance(asset)),
      light(device, asset.faceSize), relighter(device, asset, {}),
      view(device, asset, {.isUnshadowed = isUnshadowed, .preparesAllMaterials = !isUnshadowed}),
      surfaces(partMeshes(asset)), occluder(asset.occluder, asset.visibilitySize) {}

int termsOf(const Model& model) {
    int terms = 0;
    for (const AssetPart& part : model.asset.parts) terms = std::max(terms, part.sets[0].brdf.terms);
    return terms;
}

std::optional<RayHit> pick(const Model& model, const Camera& camera, vec2 pixel, ivec2 size) {
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= float(size.x) || pixel.y >= float(size.y))
        return std::nullopt;
    return model.surfaces.intersect(camera.eye,
                                    camera.pixelDirection(int(pixel.x), int(pixel.y), size.x, size.y));
}

vec3 positionOf(const Model& model, const RayHit& hit) {
    const Mesh& mesh = model.asset.parts[hit.mesh].mesh;
    const uvec3 corners = mesh.triangles[hit.triangle];
    return hit.weights.x * mesh.positions[corners.x] + hit.weights.y * mesh.positions[corners.y] +
           hit.weights.z * mesh.positions[corners.z];
}

} // namespace relume

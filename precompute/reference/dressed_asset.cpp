#include "precompute/reference/dressed_asset.h"

#include "engine/base/check.h"
#include "engine/render/layer_weights.h"

namespace relume {

std::vector<const Mesh*> partMeshes(const Asset& asset) {
    std::vector<const Mesh*> meshes;
    for (const AssetPart& part : asset.parts) meshes.push_back(&part.mesh);
    return meshes;
}

Mesh mergedMesh(const Asset& asset) {
    Mesh merged;
    for (const AssetPart& part : asset.parts) append(merged, part.mesh);
    return merged;
}

vec3 SurfacePoint::reflected(vec3 incoming) const {
    vec3 f(0);
    for (const auto& [weight, brdf] : layers) f += weight * brdf.evaluate(incoming);
    return f;
}

std::vector<vec3> SurfacePoint::layerWeights() const {
    std::vector<vec3> weights;
    for (const Layer& layer : layers) weights.push_back(layer.weight);
    return weights;
}

DressedAsset::DressedAsset(const Asset& asset, const Appearance& appearance, ReferenceBrdf kind,
                           MaterialBrdfs& brdfs)
    : mAsset(&asset) {
    RELUME_CHECK_EQ(appearance.size(), asset.parts.size());
    for (size_t i = 0; i < asset.parts.size(); i++) {
        const size_t worn = appearance[i].set;
        const MaterialSet& set = asset.parts[i].sets.at(worn);
        Part part{worn, wornLayers(asset.parts[i], appearance[i]), {}};
        for (const WornLayer& layer : part.layers)
            part.brdfs.push_back(kind == ReferenceBrdf::Exact ? WornBrdf(set, layer, brdfs)
                                                              : WornBrdf(set, layer));
        mParts.push_back(std::move(part));
    }
}

SurfacePoint DressedAsset::pointAt(const RayHit& hit, vec3 eye) const {
    const AssetPart& source = mAsset->parts[hit.mesh];
    const Mesh& mesh = source.mesh;
    const uvec3 corners = mesh.triangles[hit.triangle];
    const auto interpolate = [&](const auto& values) {
        return hit.weights.x * values[corners.x] + hit.weights.y * values[corners.y] +
               hit.weights.z * values[corners.z];
    };
    const vec3 position = interpolate(mesh.positions);
    const vec3 normal = interpolate(mesh.normals);
    // Opposite normals can cancel out on a fold.
    const bool isCancelled = glm::dot(normal, normal) < 1e-12f;
    const vec3 tangent = mesh.tangents.empty() ? vec3(0) : interpolate(mesh.tangents);
    const TangentFrame frame =
        tangentFrame(isCancelled ? mesh.normals[corners.x] : glm::normalize(normal), tangent);
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(glm::normalize(eye - position)));
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolate(mesh.uvs);
    const vec4 color = mesh.colors.empty() ? vec4(0) : interpolate(mesh.colors);

    SurfacePoint point{position, frame, outgoing, {}};
    const Part& part = mParts[hit.mesh];
    const std::vector<vec3> weights = layerWeights(source, part.set, part.layers, uv, color);
    point.layers.reserve(weights.size());
    for (size_t i = 0; i < weights.size(); i++)
        point.layers.push_back({weights[i], part.brdfs[i].seenFrom(outgoing)});
    return point;
}

} // namespace relume

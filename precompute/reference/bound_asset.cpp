#include "precompute/reference/bound_asset.h"

#include "engine/base/check.h"
#include "engine/render/appearance.h"

#include <algorithm>

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

BoundAsset::BoundAsset(const Asset& asset, const Appearance& appearance, ReferenceBrdf kind,
                       MaterialBrdfs& brdfs)
    : mAsset(&asset), mIsExact(kind == ReferenceBrdf::Exact) {
    RELUME_CHECK_EQ(appearance.size(), asset.parts.size());
    for (size_t i = 0; i < asset.parts.size(); i++) {
        const size_t number = appearance[i].set;
        const MaterialSet& set = asset.parts[i].sets.at(number);
        Part part{number, boundLayers(asset.parts[i], appearance[i]), {}};
        for (const BoundLayer& layer : part.layers)
            part.brdfs.push_back(kind == ReferenceBrdf::Exact ? BoundBrdf(set, layer, brdfs)
                                                              : BoundBrdf(set, layer));
        mParts.push_back(std::move(part));
    }
}

// Returns a mapped normal, bent towards the eye if it faces away. GLSL twin: shaders/lib/normal_map.glsl.
static vec3 facingNormal(vec3 normal, vec3 view) {
    constexpr float kLeastCosine = 0.05f;
    return glm::normalize(normal + std::max(kLeastCosine - glm::dot(normal, view), 0.0f) * view);
}

SurfacePoint BoundAsset::pointAt(const RayHit& hit, vec3 eye, bool isMapped) const {
    const AssetPart& source = mAsset->parts[hit.mesh];
    const Mesh& mesh = source.mesh;
    const uvec3 corners = mesh.triangles[hit.triangle];
    const auto interpolate = [&](const auto& values) {
        return hit.weights.x * values[corners.x] + hit.weights.y * values[corners.y] +
               hit.weights.z * values[corners.z];
    };
    const vec3 position = interpolate(mesh.positions);
    const vec3 sum = interpolate(mesh.normals);
    // Opposite normals can cancel out on a fold.
    const vec3 normal = glm::dot(sum, sum) < 1e-12f ? mesh.normals[corners.x] : glm::normalize(sum);
    const vec3 tangent = mesh.tangents.empty() ? vec3(0) : interpolate(mesh.tangents);
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolate(mesh.uvs);
    const vec4 color = mesh.colors.empty() ? vec4(0) : interpolate(mesh.colors);
    const vec3 view = glm::normalize(eye - position);
    const bool hasMap = isMapped && source.detail.normalMap && source.detail.normalScale != 0;
    const vec3 seen =
        hasMap ? facingNormal(detailedNormal(source.detail, normal, mesh, corners, uv), view) : normal;
    const TangentFrame frame = tangentFrame(seen, tangent);
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(view));

    SurfacePoint point{position, normal, frame, outgoing, {}, emittedRadiance(source.detail, uv)};
    const Part& part = mParts[hit.mesh];
    const std::vector<vec3> weights = layerWeights(source, part.set, part.layers, uv, color);
    point.layers.reserve(weights.size());
    for (size_t i = 0; i < weights.size(); i++)
        point.layers.push_back({weights[i], part.brdfs[i].seenFrom(outgoing)});
    return point;
}

SurfacePoint BoundAsset::limitPointAt(const RayHit& hit, vec3 eye) const {
    SurfacePoint point = bakedPointAt(hit, eye);
    const Part& part = mParts[hit.mesh];
    const ResidualSet* residual = mAsset->parts[hit.mesh].sets[part.set].residual.get();
    for (size_t i = 0; residual && i < point.layers.size(); i++)
        point.layers[i].weight *= concentrationOf(*residual->layers[size_t(part.layers[i].layer)]);
    return point;
}

} // namespace relume

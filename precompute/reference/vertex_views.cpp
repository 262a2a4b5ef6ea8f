#include "precompute/reference/vertex_views.h"

#include "engine/math/tangent_frame.h"
#include "engine/render/appearance.h"

namespace relume {

std::vector<vec3> pointViews(const FactoredBrdf& brdf, std::span<const BoundLayer> layers,
                             std::span<const vec3> weights, vec3 outgoing) {
    const MapPlace place = placeInMap(brdf.size, brdf.mapping, outgoing);
    std::vector<vec3> views(size_t(brdf.terms), vec3(0));
    for (size_t term = 0; term < views.size(); term++)
        for (size_t i = 0; i < layers.size(); i++)
            views[term] += weights[i] * lookupMap(brdf.viewMap(layers[i].layer, int(term)), place);
    return views;
}

std::vector<vec3> vertexViews(const AssetPart& part, const PartAppearance& appearance, uint32_t vertex,
                              vec3 eye) {
    const Mesh& mesh = part.mesh;
    const vec3 outgoing =
        liftAboveHorizon(frameOf(mesh, vertex).toLocal(glm::normalize(eye - mesh.positions[vertex])));
    const std::vector<BoundLayer> layers = boundLayers(part, appearance);
    const std::vector<vec3> weights =
        layerWeights(part, appearance.set, layers, mesh.uvs.empty() ? vec2(0) : mesh.uvs[vertex],
                     mesh.colors.empty() ? vec4(0) : mesh.colors[vertex]);
    return pointViews(part.sets[appearance.set].brdf, layers, weights, outgoing);
}

} // namespace relume

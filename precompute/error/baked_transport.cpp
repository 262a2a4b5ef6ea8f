#include "precompute/error/baked_transport.h"

#include "engine/math/haar.h"

#include <cmath>

namespace relume {

BakedTransport::BakedTransport(const Asset& asset)
    : mAsset(asset), mLighting(asset.faceSize),
      mEvaluations(asset.faceSize * int(std::lround(std::sqrt(double(asset.transportSamples))))),
      mVisibility(asset.occluder, asset.visibilitySize) {}

std::vector<uint64_t> BakedTransport::visibility(vec3 position, vec3 normal) const {
    std::vector<uint64_t> bits(mVisibility.texels() / 64);
    mVisibility.trace(position + mAsset.visibilityOffset * normal, normal, bits);
    return bits;
}

std::vector<LitCell> BakedTransport::lit(std::span<const uint64_t> visibility,
                                         const TangentFrame& frame) const {
    return litCells(mEvaluations, mLighting, visibility, frame);
}

void BakedTransport::forEachTerm(size_t part, uint32_t vertex, const FactoredBrdf& brdf,
                                 const std::function<void(size_t, const std::vector<vec3>&)>& use) const {
    const Mesh& mesh = mAsset.parts[part].mesh;
    const vec3 normal = mesh.normals[vertex];
    const std::vector<LitCell> cells = lit(visibility(mesh.positions[vertex], normal), frameOf(mesh, vertex));
    const std::vector<MapPlace> places = placesOf(cells, brdf.size, brdf.mapping);
    for (int term = 0; term < brdf.terms; term++) {
        std::vector<vec3> transport = transportOf(cells, places, brdf.lightMap(term), mLighting.count());
        haarForwardFaces(transport, mAsset.faceSize);
        use(size_t(term), transport);
    }
}

std::vector<vec3> dequantizedLight(const LightVector& light) {
    std::vector<vec3> coefficients(size_t(6 * light.faceSize * light.faceSize), vec3(0));
    for (size_t i = 0; i < light.indices.size(); i++) {
        const auto& value = light.values[i];
        coefficients[light.indices[i]] = light.scale * vec3(value[0], value[1], value[2]);
    }
    return coefficients;
}

} // namespace relume

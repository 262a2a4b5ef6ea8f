#include "precompute/error/vertex_probe.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/reference/vertex_views.h"

namespace relume {

namespace {

std::vector<float> visibleShares(const Asset& asset, const CpuVisibility& occluder, vec3 position,
                                 vec3 normal) {
    const int size = asset.visibilitySize, side = size / asset.faceSize;
    const auto faceTexels = uint32_t(size * size);
    std::vector<uint64_t> bits(occluder.texels() / 64);
    occluder.trace(position + asset.visibilityOffset * normal, normal, bits);
    std::vector<float> shares(size_t(kCubeFaces) * size_t(asset.faceSize) * size_t(asset.faceSize), 0);
    for (uint32_t i = 0; i < kCubeFaces * faceTexels; i++) {
        const ivec2 place = mortonPlace(i % faceTexels) / side;
        if (bits[i / 64] >> i % 64 & 1)
            shares[size_t(cubeTexelIndex(int(i / faceTexels), place.x, place.y, asset.faceSize))] +=
                1 / float(side * side);
    }
    return shares;
}

vec3 innerProduct(const std::vector<vec3>& coefficients, const LightVector& light) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < light.indices.size(); i++) {
        const auto& value = light.values[i];
        sum += glm::dvec3(coefficients[light.indices[i]]) * glm::dvec3(value[0], value[1], value[2]);
    }
    return vec3(sum * double(light.scale));
}

} // namespace

VertexProbe probeVertex(const Asset& asset, const CpuVisibility& occluder, size_t part, uint32_t vertex,
                        vec3 eye, const PartAppearance& appearance, const LightCube& light,
                        const LightVector& lightVector) {
    RELUME_CHECK_LT(part, asset.parts.size());
    RELUME_CHECK_EQ(light.size, asset.faceSize);
    RELUME_CHECK_EQ(lightVector.faceSize, asset.faceSize);
    const AssetPart& source = asset.parts[part];
    RELUME_CHECK_LT(vertex, source.mesh.vertexCount());
    const MaterialSet& set = source.sets.at(appearance.set);
    const vec3 position = source.mesh.positions[vertex], normal = source.mesh.normals[vertex];

    VertexProbe probe;
    probe.visibility = visibleShares(asset, occluder, position, normal);
    probe.views = vertexViews(source, appearance, vertex, eye);
    probe.transport = {asset.faceSize, std::vector<vec3>(light.radiance.size(), vec3(0))};
    std::vector<vec3>& transport = probe.transport.radiance;
    glm::dvec3 radiance(0);
    for (size_t term = 0; term < probe.views.size(); term++) {
        const std::vector<vec3> coefficients =
            dequantizedRow(set.transport, size_t(vertex) * probe.views.size() + term, transport.size());
        for (size_t i = 0; i < transport.size(); i++) transport[i] += probe.views[term] * coefficients[i];
        probe.tuple.push_back(innerProduct(coefficients, lightVector));
        radiance += glm::dvec3(probe.views[term]) * glm::dvec3(probe.tuple[term]);
    }
    probe.radiance = vec3(radiance);
    haarInverseFaces(transport, asset.faceSize);
    glm::dvec3 full(0);
    for (size_t i = 0; i < transport.size(); i++)
        full += glm::dvec3(transport[i]) * glm::dvec3(light.radiance[i]);
    probe.fullRadiance = vec3(full);
    return probe;
}

} // namespace relume

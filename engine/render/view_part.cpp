#include "engine/render/view_part.h"

#include "engine/base/error.h"
#include "engine/render/numbered_triangles.h"
#include "engine/scene/closed_mesh.h"
#include "engine/vk/upload.h"

#include <algorithm>
#include <fmt/core.h>
#include <span>

namespace relume {

namespace {

// Throws unless the device can read `texels` of a buffer, each of 16 bytes.
void expectTexels(const vk::Device& device, uint64_t texels, const std::string& name) {
    const uint64_t most = device.mostTexels(sizeof(vec4));
    if (texels > most)
        throw Error(fmt::format(
            "{}: {} texels are needed, {} reads at most {} of a buffer; split the mesh into several parts",
            name, texels, device.name(), most));
}

template <typename T>
vk::Buffer uploadBindable(const vk::Device& device, const std::vector<T>& values, const std::string& name) {
    const uint64_t bytes = std::span(values).size_bytes();
    if (bytes > device.largestStorageBuffer())
        throw Error(
            fmt::format("{}: {} bytes are needed, {} binds at most {}; split the mesh into several parts",
                        name, bytes, device.name(), device.largestStorageBuffer()));
    return vk::upload<T>(device, values, name);
}

std::vector<shared::ViewVertex> verticesOf(const Mesh& mesh) {
    RELUME_CHECK_EQ(mesh.normals.size(), mesh.positions.size());
    std::vector<shared::ViewVertex> vertices;
    vertices.reserve(mesh.vertexCount());
    for (size_t v = 0; v < mesh.vertexCount(); v++)
        vertices.push_back({mesh.positions[v], mesh.normals[v], mesh.uvs.empty() ? vec2(0) : mesh.uvs[v],
                            mesh.colors.empty() ? vec4(0) : mesh.colors[v],
                            mesh.tangents.empty() ? vec3(0) : mesh.tangents[v], 0});
    return vertices;
}

std::vector<glm::u32vec4> cornersOf(const Mesh& mesh) {
    std::vector<glm::u32vec4> corners;
    corners.reserve(mesh.triangleCount());
    for (const uvec3& triangle : mesh.triangles) corners.emplace_back(triangle, 0);
    return corners;
}

shared::ViewDetail detailOf(const AssetPart& part) {
    return {part.detail.emission, part.detail.normalMap ? part.detail.normalScale : 0, part.tintedByColors};
}

// Returns the cheapest of the shader's variants that handles these layers and the detail.
uint32_t lookOf(const std::vector<shared::ViewLayer>& layers, bool isDetailed) {
    if (isDetailed) return shared::kSurfaceLook;
    for (const shared::ViewLayer& layer : layers)
        if (layer.channel >= 0 || layer.isTextured) return shared::kSurfaceLook;
    return layers.size() == 1 ? shared::kSingleLook : shared::kLayersLook;
}

ViewSet makeSet(const vk::Device& device, const MaterialSet& source, const std::string& name) {
    ViewSet set;
    set.terms = uint32_t(source.brdf.terms);
    RELUME_CHECK_EQ(set.terms, termsOf(source.transport));
    expectTexels(device, (3 * uint64_t(verticesOf(source.transport)) * set.terms + 3) / 4, name + " tuples");
    set.materials = uint32_t(source.materials.size());
    set.mapping = source.brdf.mapping;
    set.viewMaps = makeViewMapTexture(device, source.brdf, name + " view maps");
    if (!source.directShares.empty())
        set.directShares = uploadBindable(device, source.directShares, name + " direct shares");
    return set;
}

} // namespace

ViewPart::ViewPart(const vk::Device& device, const AssetPart& source, uint32_t firstId)
    : bounds(boundsOf(source.mesh)), isClosed(relume::isClosed(source.mesh)), clusters(source.mesh),
      firstTriangleId(firstId), triangleCount(uint32_t(source.mesh.triangleCount())),
      paint(source.paintedByColors ? shared::kPaintedByColors
            : source.materialMap   ? shared::kPaintedByMap
                                   : shared::kUnpainted),
      detail(detailOf(source)), isDetailed(source.detail.isAny()) {
    const NumberedTriangles numbered = numberTriangles(source.mesh);
    const uint64_t mostVertices = uint64_t(device.limits().maxDrawIndexedIndexValue) + 1;
    if (numbered.positions.size() > mostVertices)
        throw Error(
            fmt::format("{}: {} vertices are drawn, {} counts at most {}; split the mesh into several parts",
                        source.name, numbered.positions.size(), device.name(), mostVertices));
    drawnPositions = vk::upload<vec3>(device, numbered.positions, source.name + " drawn positions");
    drawnTriangles = vk::upload<uvec3>(device, numbered.triangles, source.name + " drawn triangles");
    expectTexels(device, shared::kVertexTexels * source.mesh.vertexCount(), source.name + " vertices");
    expectTexels(device, source.mesh.triangleCount(), source.name + " triangles");
    vertices = uploadBindable(device, verticesOf(source.mesh), source.name + " vertices");
    triangles = vk::upload<glm::u32vec4>(device, cornersOf(source.mesh), source.name + " triangles");
    const Texture white{1, 1, {0xffffffff}};
    baseColor = makeSurfaceTexture(device, source.baseColor.value_or(white), source.name + " base color");
    materialMap =
        makeSurfaceTexture(device, source.materialMap.value_or(white), source.name + " material map");
    normalMap =
        makeSurfaceTexture(device, source.detail.normalMap.value_or(white), source.name + " normal map");
    emissionMap =
        makeSurfaceTexture(device, source.detail.emissionMap.value_or(white), source.name + " emission map");
    size_t mostLayers = 1;
    for (const MaterialSet& set : source.sets) {
        RELUME_CHECK_EQ(size_t(verticesOf(set.transport)), source.mesh.vertexCount());
        sets.push_back(makeSet(device, set, source.name));
        sets.back().hasTangents = !source.mesh.tangents.empty();
        mostLayers = std::max(mostLayers, 2 * set.materials.size());
    }
    layers = vk::Buffer(device, sizeof(shared::ViewDetail) + mostLayers * sizeof(shared::ViewLayer),
                        vk::BufferUse::Device, source.name + " bound layers");
}

void ViewPart::bind(const AssetPart& source, const PartAppearance& appearance) {
    bound = appearance;
    boundLayers.clear();
    for (const BoundLayer& layer : relume::boundLayers(source, bound))
        boundLayers.push_back({uint32_t(layer.layer) * boundSet().viewMaps.imagesPerLayer, layer.channel,
                               layer.textured, layer.weight, 0, 0});
    look = lookOf(boundLayers, isDetailed);
}

std::vector<uint32_t> looksOf(const AssetPart& part, const MaterialSet& set) {
    if (part.detail.isAny()) return {shared::kSurfaceLook};
    const auto bases = size_t(std::ranges::count(set.materials, true, &AssetMaterial::hasBase));
    const size_t plain = set.materials.size() - bases;
    std::vector<uint32_t> looks;
    if (plain > 0) looks.push_back(shared::kSingleLook);
    if (plain > 1) looks.push_back(shared::kLayersLook);
    if (bases > 0 || part.isPainted()) looks.push_back(shared::kSurfaceLook);
    return looks;
}

} // namespace relume

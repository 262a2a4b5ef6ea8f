#include "engine/base/error.h"
#include "engine/import/gltf_document.h"
#include "engine/import/gltf_geometry.h"
#include "engine/import/gltf_material.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/texture_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace relume {
namespace {

// The name, with the material's number or a greater one if it is taken.
std::string uniqueName(const std::string& name, int number, std::set<std::string>& names) {
    std::string unique = name;
    while (!names.insert(unique).second) unique = fmt::format("{} ({})", name, number++);
    return unique;
}

// The numbers of materials of which some primitive has vertex colors.
std::set<int> coloredMaterials(const tinygltf::Model& model) {
    std::set<int> colored;
    for (const tinygltf::Mesh& mesh : model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            if (primitive.attributes.contains("COLOR_0")) colored.insert(std::max(primitive.material, -1));
    return colored;
}

void addTextures(GltfMaterials& materials, const GltfMaterial& material, GltfPart& part) {
    if (material.baseColor) part.baseColor = materials.readTexture(*material.baseColor, true);
    if (material.blendWeights) {
        part.material = material.blend;
        part.materialMap = material.blendWeights;
    }
    if (material.normalMap) part.detail.normalMap = materials.readTexture(*material.normalMap, false);
    part.detail.normalScale = material.normalScale;
    if (material.emissionMap) part.detail.emissionMap = materials.readTexture(*material.emissionMap, true);
}

} // namespace

Mesh decodeGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& name, MeshAttributes wanted) {
    const GltfDocument document = readGltfDocument(bytes, folder, name);
    Mesh whole;
    for (const auto& [material, mesh] : readGltfGeometry(
             document.model, [&](int) { return GltfWish{.attributes = wanted}; }, name))
        append(whole, mesh);
    return whole;
}

GltfParts decodeGltfParts(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                          const std::string& name) {
    const GltfDocument document = readGltfDocument(bytes, folder, name);
    GltfMaterials materials(document, folder, name);
    const std::set<int> colored = coloredMaterials(document.model);
    const auto wishOf = [&](int number) {
        const GltfMaterial& material = materials.at(number);
        GltfWish wish{{.uvs = material.placement.has_value(), .colors = colored.contains(number)}};
        wish.isTint = true;
        if (material.placement) {
            wish.uvSet = material.placement->uvSet;
            wish.uvTransform = material.placement->uvTransform;
        }
        return wish;
    };
    GltfParts result;
    std::set<std::string> names;
    for (auto& [number, mesh] : readGltfGeometry(document.model, wishOf, name)) {
        if (mesh.triangles.empty()) continue;
        const GltfMaterial& material = materials.at(number);
        GltfPart part{uniqueName(material.name, number, names), std::move(mesh), material.text, {}, {}, {}};
        part.mesh = cleanUp(std::move(part.mesh), fmt::format("{}: \"{}\"", name, part.name));
        part.detail.emission = material.emission;
        const auto isWhite = [](const vec4& color) { return vec3(color) == vec3(1); };
        if (std::ranges::all_of(part.mesh.colors, isWhite)) part.mesh.colors.clear();
        if (!part.mesh.uvs.empty()) {
            addTextures(materials, material, part);
        } else if (material.placement) {
            materials.ignore("textures where the mesh has no texture coordinates");
            if (material.emissionMap) part.detail.emission = vec3(0);
        }
        result.parts.push_back(std::move(part));
    }
    if (result.parts.empty())
        throw Error(fmt::format("{}: holds no triangles: expected a surface to bake", name));
    for (const auto& [file, hash] : materials.files()) result.images.push_back({file, hash});
    materials.logIgnored();
    return result;
}

} // namespace relume

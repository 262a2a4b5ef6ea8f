#include "engine/base/error.h"
#include "engine/import/gltf_document.h"
#include "engine/import/gltf_geometry.h"
#include "engine/import/gltf_material.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/texture_file.h"

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

bool hasColors(const tinygltf::Model& model) {
    for (const tinygltf::Mesh& mesh : model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            if (primitive.attributes.contains("COLOR_0")) return true;
    return false;
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
    const auto wishOf = [&](int number) {
        const GltfMaterial& material = materials.at(number);
        return GltfWish{{.uvs = material.baseColor.has_value()}, material.uvSet, material.uvTransform};
    };
    GltfParts result;
    std::set<std::string> names;
    for (auto& [number, mesh] : readGltfGeometry(document.model, wishOf, name)) {
        if (mesh.triangles.empty()) continue;
        const GltfMaterial& material = materials.at(number);
        GltfPart part{uniqueName(material.name, number, names), std::move(mesh), material.text, std::nullopt};
        part.mesh = cleanUp(std::move(part.mesh), fmt::format("{}: \"{}\"", name, part.name));
        if (material.baseColor && !part.mesh.uvs.empty())
            part.baseColor = materials.readTexture(*material.baseColor, true);
        else if (material.baseColor)
            materials.ignore("a texture where the mesh has no texture coordinates");
        result.parts.push_back(std::move(part));
    }
    if (result.parts.empty())
        throw Error(fmt::format("{}: holds no triangles: expected a surface to bake", name));
    for (const auto& [file, hash] : materials.files()) result.images.push_back({file, hash});
    if (hasColors(document.model)) materials.ignore("COLOR_0");
    materials.logIgnored();
    return result;
}

} // namespace relume

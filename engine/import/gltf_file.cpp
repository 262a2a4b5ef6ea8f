#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/import/alpha_cut.h"
#include "engine/import/gltf_document.h"
#include "engine/import/gltf_geometry.h"
#include "engine/import/gltf_material.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/texture_file.h"

#include <algorithm>
#include <fmt/core.h>
#include <set>

namespace relume {
namespace {

// The tolerance of holes as a share of the radius of the file's bounds: half a pixel in an image 1,000 wide.
constexpr float kHoleTolerance = 1e-3f;

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

// Whether a blended texture is a mask with soft edges: at least nine tenths of its texels are nearly clear or
// nearly opaque, and there are both.
bool isNearlyMask(const Texture& texture, float opacity) {
    size_t clear = 0, opaque = 0;
    for (const uint32_t texel : texture.texels) {
        const float alpha = opacity * float(texel >> 24) / 255;
        clear += alpha <= 0.1f, opaque += alpha >= 0.9f;
    }
    return clear > 0 && opaque > 0 && 10 * (clear + opaque) >= 9 * texture.texelCount();
}

// Cuts holes where the material has them.
void cutHoles(GltfMaterials& materials, const GltfMaterial& material, float tolerance,
              const std::string& name, GltfPart& part) {
    if (material.alpha == GltfAlpha::Opaque) return;
    const Texture* texture = part.baseColor ? &*part.baseColor : nullptr;
    if (material.alpha == GltfAlpha::Blend && !(texture && isNearlyMask(*texture, material.opacity))) {
        materials.ignore("alphaMode BLEND (drawn opaque)");
        return;
    }
    part.mesh =
        cutByAlpha(std::move(part.mesh), {texture, material.opacity, material.alphaCutoff}, tolerance, name);
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
        GltfWish wish{{.uvs = material.placement || material.isBrushed, .colors = colored.contains(number)}};
        wish.isTint = true;
        wish.brushRotation = material.brushRotation;
        if (material.placement) {
            wish.uvSet = material.placement->uvSet;
            wish.uvTransform = material.placement->uvTransform;
        }
        return wish;
    };
    GltfParts result;
    std::set<std::string> names;
    std::map<int, Mesh> meshes = readGltfGeometry(document.model, wishOf, name);
    Bounds bounds;
    for (const auto& [number, mesh] : meshes) bounds.add(boundsOf(mesh));
    for (auto& [number, mesh] : meshes) {
        if (mesh.triangles.empty()) continue;
        const GltfMaterial& material = materials.at(number);
        GltfPart part{uniqueName(material.name, number, names), std::move(mesh), material.text, {}, {}, {}};
        const std::string partName = fmt::format("{}: \"{}\"", name, part.name);
        part.mesh = cleanUp(std::move(part.mesh), partName);
        part.detail.emission = material.emission;
        if (!part.mesh.uvs.empty()) {
            addTextures(materials, material, part);
        } else if (material.placement) {
            materials.ignore("textures where the mesh has no texture coordinates");
            if (material.emissionMap) part.detail.emission = vec3(0);
        }
        if (material.isBrushed && part.mesh.uvs.empty() && part.mesh.tangents.empty())
            materials.ignore(
                "directions of anisotropy where the mesh has neither tangents nor texture coordinates "
                "(they follow a smooth field)");
        cutHoles(materials, material, kHoleTolerance * bounds.radius(), partName, part);
        if (part.mesh.triangles.empty()) {
            log(LogLevel::Info,
                fmt::format("{}: is left out, since its alpha is below its cutoff", partName));
            continue;
        }
        const auto isWhite = [](const vec4& color) { return vec3(color) == vec3(1); };
        if (std::ranges::all_of(part.mesh.colors, isWhite)) part.mesh.colors.clear();
        result.parts.push_back(std::move(part));
    }
    if (result.parts.empty())
        throw Error(fmt::format("{}: holds no triangles: expected a surface to bake", name));
    for (const auto& [file, hash] : materials.files()) result.images.push_back({file, hash});
    materials.logIgnored();
    return result;
}

} // namespace relume

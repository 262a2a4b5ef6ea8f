#include "engine/scene/gltf_document.h"
#include "engine/scene/gltf_geometry.h"
#include "engine/scene/mesh_formats.h"

namespace relume {
Mesh decodeGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& name, MeshAttributes wanted) {
    const GltfDocument document = readGltfDocument(bytes, folder, name);
    Mesh whole;
    for (const auto& [material, mesh] : readGltfGeometry(
             document.model, [&](int) { return GltfWish{.attributes = wanted}; }, name))
        append(whole, mesh);
    return whole;
}

} // namespace relume

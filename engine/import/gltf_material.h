// The materials of a glTF file and their images: metallic-roughness, from JSON that nothing has checked.
#pragma once

#include "engine/import/gltf_document.h"
#include "engine/import/gltf_geometry.h"
#include "engine/import/texture_file.h"
#include "engine/scene/texture.h"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace relume {

struct GltfMaterial {
    std::string name;
    std::string text;                // {"model": "gltf", "base_color", "metallic", "roughness"}, linear
    std::optional<size_t> baseColor; // number of the texture that multiplies base_color
    int uvSet = 0;                   // of that texture
    mat3 uvTransform = mat3(1);      // KHR_texture_transform, of (u, v, 1)
};

class GltfMaterials {
  public:
    // All three must outlive it. Image files are read from `folder` and below only.
    GltfMaterials(const GltfDocument& document, const std::filesystem::path& folder, const std::string& name)
        : mDocument(document), mFolder(folder), mName(name) {}

    // The material of this number, or glTF's default for -1. Its metallic-roughness texture is averaged.
    const GltfMaterial& at(int index);

    // The image of texture number `index`.
    Texture readTexture(size_t index, bool srgb);

    // The image files that were read, each once.
    const std::map<std::string, std::string>& files() const { return mFiles; } // path to hash

    // Tells the log, once for the whole file, what else materials have that is not supported.
    void logIgnored() const;
    void ignore(const std::string& what) { mIgnored.insert(what); }

  private:
    using Json = nlohmann::json;

    GltfMaterial read(int index);
    void readBaseColorTexture(const Json& info, const std::string& place, GltfMaterial& material);
    void noteIgnored(const Json& json, const std::string& place);
    void noteSampler(const Json& texture, const std::string& place);
    std::vector<std::byte> readImageBytes(const Json& image, const std::string& place);

    const GltfDocument& mDocument;
    const std::filesystem::path& mFolder;
    const std::string& mName;
    std::map<int, GltfMaterial> mMaterials;
    std::map<std::string, std::string> mFiles;
    std::set<std::string> mIgnored;
    size_t mTexels = 0; // decoded so far
};

} // namespace relume

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

// The placement of a texture's texels on a mesh.
struct GltfPlacement {
    int uvSet = 0;              // the N of TEXCOORD_N
    mat3 uvTransform = mat3(1); // KHR_texture_transform, of (u, v, 1)

    bool operator==(const GltfPlacement&) const = default;
};

enum class GltfAlpha { Opaque, Mask, Blend };

struct GltfMaterial {
    std::string name;
    std::string text; // {"model": "gltf", "base_color", "metallic", "roughness", …}, linear
    std::optional<GltfPlacement> placement; // of all its textures; none: it has none
    std::optional<size_t> baseColor;        // number of the texture that multiplies base_color
    // The set of materials that blend where metalness or roughness vary, and the texture of their weights.
    std::string blend;
    std::optional<Texture> blendWeights = std::nullopt;
    bool isBrushed = false;  // whether it follows tangents
    float brushRotation = 0; // of its strokes, from the tangent towards the bitangent
    std::optional<size_t> normalMap, emissionMap;
    float normalScale = 1;
    vec3 emission = vec3(0);
    GltfAlpha alpha = GltfAlpha::Opaque;
    float opacity = 1, alphaCutoff = 0.5f; // opacity multiplies the alpha of texture and vertices
};

class GltfMaterials {
  public:
    // All three must outlive it. Image files are read from `folder` and below only.
    GltfMaterials(const GltfDocument& document, const std::filesystem::path& folder, const std::string& name)
        : mDocument(document), mFolder(folder), mName(name) {}

    // The material of this number, or glTF's default for -1.
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
    // The number of a texture that lies where the material's others do; none, too, if it does not.
    std::optional<size_t> placedTexture(const Json& json, const char* key, const std::string& place,
                                        GltfMaterial& material);
    void readAlpha(const Json& json, const std::string& place, GltfMaterial& material);
    void readDetail(const Json& json, const std::string& place, GltfMaterial& material);
    // `extensions`: parameters that they add. `name`: of the material, without control characters.
    void readMetalRoughness(const Json& surface, const nlohmann::ordered_json& extensions,
                            const std::string& place, const std::string& name, GltfMaterial& material);
    void noteSampler(const Json& texture, const std::string& place);
    std::vector<std::byte> readImageBytes(const Json& image, const std::string& place);

    const GltfDocument& mDocument;
    const std::filesystem::path& mFolder;
    const std::string& mName;
    std::map<int, GltfMaterial> mMaterials;
    std::map<std::string, std::string> mFiles;
    std::set<std::string> mIgnored;
    size_t mTexels = 0;     // decoded so far
    size_t mImageBytes = 0; // of image files and of images as text, each counted once
    std::set<const Json*> mTextImages;
};

} // namespace relume

#include "engine/import/gltf_material.h"
#include "engine/base/log.h"
#include "engine/import/texture_file.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/import/gltf_accessor.h"
#include "engine/import/gltf_extensions.h"
#include "engine/import/gltf_json.h"
#include "engine/import/metal_roughness_map.h"
#include "engine/scene/surface_detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/ranges.h>

namespace relume {
namespace {

using Json = nlohmann::json;

// More than any file needs; a bound on what a small one can unfold to, whose materials share an image: a
// gigabyte of texels must come from megabytes.
constexpr size_t kMostTexels = size_t(1) << 29, kTexelsAlwaysFine = size_t(1) << 26, kTexelsPerByte = 64;

// Element number `index` of one of the document's lists; `place` becomes its name in errors.
const Json& element(const Json& looks, const char* list, size_t index, const std::string& name,
                    std::string& place) {
    const auto found = looks.find(list);
    const size_t count = found == looks.end() || !found->is_array() ? 0 : found->size();
    if (index >= count)
        throw Error(fmt::format("{}: refers to number {} of its {}, but there are only {}", name, index, list,
                                count));
    place = fmt::format("{}: {}[{}]", name, list, index);
    return (*found)[index];
}

// Turns counter-clockwise as seen, where v goes down; scales first, moves last.
mat3 textureTransform(const Json& extension, const std::string& place) {
    const std::vector<double> offset = gltfNumbers(extension, "offset", {0, 0}, place);
    const std::vector<double> scale = gltfNumbers(extension, "scale", {1, 1}, place);
    const double angle = gltfNumber(extension, "rotation", 0, place);
    const float c = float(std::cos(angle)), s = float(std::sin(angle));
    return {vec3(c, -s, 0) * float(scale[0]), vec3(s, c, 0) * float(scale[1]),
            vec3(float(offset[0]), float(offset[1]), 1)};
}

} // namespace

const GltfMaterial& GltfMaterials::at(int index) {
    const auto found = mMaterials.find(index);
    return found != mMaterials.end() ? found->second : mMaterials.emplace(index, read(index)).first->second;
}

GltfMaterial GltfMaterials::read(int index) {
    static const Json kDefault = Json::object();
    GltfMaterial material;
    std::string place = mName + ": default material";
    const Json& json =
        index < 0 ? kDefault : element(mDocument.looks, "materials", size_t(index), mName, place);
    material.name = gltfText(json, "name", place);
    if (material.name.empty())
        material.name = index < 0 ? "default material" : fmt::format("material {}", index);

    std::string printable = material.name; // names are written on command lines
    for (char& letter : printable)
        if (uint8_t(letter) < 0x20 || letter == 0x7f) letter = ' ';
    const Json& surface = gltfObject(json, "pbrMetallicRoughness", place);
    material.baseColor = placedTexture(surface, "baseColorTexture", place, material);
    const nlohmann::ordered_json extensions =
        readGltfExtensions(json, place, [&](const std::string& what) { ignore(what); });
    material.isBrushed = extensions.value("anisotropy", 0.0) > 0;
    material.brushRotation = float(glm::radians(extensions.value("anisotropy_rotation", 0.0)));
    readMetalRoughness(surface, extensions, place, printable, material);
    readDetail(json, place, material);
    readAlpha(json, place, material);
    if (findGltfMember(json, "occlusionTexture", place)) ignore("occlusionTexture (visibility is baked)");
    return material;
}

void GltfMaterials::readMetalRoughness(const Json& surface, const nlohmann::ordered_json& extensions,
                                       const std::string& place, const std::string& name,
                                       GltfMaterial& material) {
    std::vector<double> base = gltfNumbers(surface, "baseColorFactor", {1, 1, 1, 1}, place);
    material.opacity = float(std::clamp(base.back(), 0.0, 1.0));
    base.pop_back();
    double metallic = gltfNumber(surface, "metallicFactor", 1, place);
    double roughness = gltfNumber(surface, "roughnessFactor", 1, place);
    for (double* value : {&base[0], &base[1], &base[2], &metallic, &roughness})
        *value = std::clamp(*value, 0.0, 1.0);
    const auto describe = [&](const std::string& called, double metallicness, double rough) {
        nlohmann::ordered_json json = {{"name", called},
                                       {"model", "gltf"},
                                       {"base_color", base},
                                       {"metallic", metallicness},
                                       {"roughness", rough}};
        json.update(extensions);
        return json;
    };
    const auto print = [](const nlohmann::ordered_json& json) {
        return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    };
    const Json& info = gltfObject(surface, "metallicRoughnessTexture", place);
    const std::optional<size_t> texture = gltfIndex(info, "index", place);
    if (!texture) {
        material.text = print(describe(name, metallic, roughness));
        return;
    }
    const Texture image = readTexture(*texture, false);
    const vec4 mean = meanOf(image);
    material.text = print(describe(name, metallic * double(mean.z), roughness * double(mean.y)));
    std::optional<MetalRoughnessMap> map = blendMetalRoughness(image, float(metallic), float(roughness));
    if (!map || !placedTexture(surface, "metallicRoughnessTexture", place, material)) return;
    nlohmann::ordered_json set = nlohmann::ordered_json::array();
    for (const MetalRoughness& node : map->nodes)
        set.push_back(describe(
            fmt::format("{} (metallic {:.2f}, roughness {:.2f})", name, node.metallic, node.roughness),
            double(node.metallic), double(node.roughness)));
    material.blend = print({{"set", set}});
    material.blendWeights = std::move(map->weights);
}

void GltfMaterials::readAlpha(const Json& json, const std::string& place, GltfMaterial& material) {
    const std::string mode = gltfText(json, "alphaMode", place);
    if (mode == "MASK") {
        material.alpha = GltfAlpha::Mask;
        material.alphaCutoff = float(std::clamp(gltfNumber(json, "alphaCutoff", 0.5, place), 0.0, 2.0));
    } else if (mode == "BLEND") {
        material.alpha = GltfAlpha::Blend;
    } else if (!mode.empty() && mode != "OPAQUE") {
        ignore("alphaMode " + mode.substr(0, 20));
    }
}

void GltfMaterials::readDetail(const Json& json, const std::string& place, GltfMaterial& material) {
    material.normalMap = placedTexture(json, "normalTexture", place, material);
    if (material.normalMap)
        material.normalScale =
            float(std::clamp(gltfNumber(gltfObject(json, "normalTexture", place), "scale", 1, place),
                             -double(kLargestNormalScale), double(kLargestNormalScale)));
    const double strength = gltfNumber(
        gltfObject(gltfObject(json, "extensions", place), "KHR_materials_emissive_strength", place),
        "emissiveStrength", 1, place);
    const std::vector<double> emission = gltfNumbers(json, "emissiveFactor", {0, 0, 0}, place);
    for (int channel = 0; channel < 3; channel++)
        material.emission[channel] =
            float(std::clamp(strength * emission[size_t(channel)], 0.0, double(kLargestEmission)));
    if (material.emission == vec3(0)) return;
    material.emissionMap = placedTexture(json, "emissiveTexture", place, material);
    if (!material.emissionMap && findGltfMember(json, "emissiveTexture", place)) material.emission = vec3(0);
}

std::optional<size_t> GltfMaterials::placedTexture(const Json& json, const char* key,
                                                   const std::string& place, GltfMaterial& material) {
    if (!findGltfMember(json, key, place)) return std::nullopt;
    const Json& info = gltfObject(json, key, place);
    const std::optional<size_t> texture = gltfIndex(info, "index", place);
    if (!texture) return std::nullopt;
    GltfPlacement placement{int(gltfIndex(info, "texCoord", place).value_or(0))};
    const Json& extensions = gltfObject(info, "extensions", place);
    if (findGltfMember(extensions, "KHR_texture_transform", place)) {
        const Json& transform = gltfObject(extensions, "KHR_texture_transform", place);
        placement.uvTransform = textureTransform(transform, place);
        placement.uvSet = int(gltfIndex(transform, "texCoord", place).value_or(size_t(placement.uvSet)));
    }
    if (!material.placement) material.placement = placement;
    if (*material.placement == placement) return texture;
    ignore(
        fmt::format("{} where its texture coordinates are not those of the material's first texture", key));
    return std::nullopt;
}

void GltfMaterials::noteSampler(const Json& texture, const std::string& place) {
    constexpr double kRepeat = 10497;
    const std::optional<size_t> number = gltfIndex(texture, "sampler", place);
    if (!number) return;
    std::string samplerPlace;
    const Json& sampler = element(mDocument.looks, "samplers", *number, mName, samplerPlace);
    for (const char* axis : {"wrapS", "wrapT"})
        if (gltfNumber(sampler, axis, kRepeat, samplerPlace) != kRepeat)
            ignore("wrapping other than by repetition");
}

std::vector<std::byte> GltfMaterials::readImageBytes(const Json& image, const std::string& place) {
    if (const std::optional<size_t> view = gltfIndex(image, "bufferView", place)) {
        const auto bytes = std::as_bytes(gltfViewBytes(mDocument.model, int(*view), mName));
        return {bytes.begin(), bytes.end()};
    }
    const std::string uri = gltfText(image, "uri", place);
    if (tinygltf::IsDataURI(uri)) {
        std::vector<unsigned char> data;
        std::string type;
        if (!tinygltf::DecodeDataURI(&data, type, uri, 0, false))
            throw Error(fmt::format("{}: its data cannot be decoded: export the file again", place));
        if (mTextImages.insert(&image).second) mImageBytes += data.size();
        const auto bytes = std::as_bytes(std::span(data));
        return {bytes.begin(), bytes.end()};
    }
    const std::filesystem::path path = findGltfFile(uri, mFolder, place);
    std::vector<std::byte> bytes = readFile(path, kLargestTextureFile);
    if (mFiles.insert_or_assign(path.string(), hashText(bytes)).second) mImageBytes += bytes.size();
    return bytes;
}

Texture GltfMaterials::readTexture(size_t index, bool srgb) {
    std::string place;
    const Json& json = element(mDocument.looks, "textures", index, mName, place);
    const std::optional<size_t> source = gltfIndex(json, "source", place);
    if (!source)
        throw Error(
            fmt::format("{}: has no PNG or JPEG image: export with such images, or name a material", place));
    noteSampler(json, place);
    const Json& image = element(mDocument.looks, "images", *source, mName, place);
    Texture texture = decodeTexture(readImageBytes(image, place), place, srgb);
    mTexels += texture.texelCount();
    size_t most = kTexelsAlwaysFine + kTexelsPerByte * mImageBytes;
    for (const tinygltf::Buffer& buffer : mDocument.model.buffers)
        most += kTexelsPerByte * buffer.data.size();
    most = std::min(most, kMostTexels);
    if (mTexels > most)
        throw Error(fmt::format(
            "{}: the textures of its materials have more than {} texels in all, which is more than "
            "its images need: scale them down, or let materials share them",
            mName, most));
    return texture;
}

void GltfMaterials::logIgnored() const {
    if (!mIgnored.empty())
        log(LogLevel::Warning,
            fmt::format("{}: not supported in materials, and ignored: {}", mName, fmt::join(mIgnored, ", ")));
}

} // namespace relume

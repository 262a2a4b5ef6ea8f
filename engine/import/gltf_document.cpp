#include "engine/import/gltf_document.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/gltf_compression.h"
#include "engine/import/gltf_json.h"
#include "engine/import/json_object.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fmt/core.h>
#include <map>
#include <string_view>
#include <utility>

namespace relume {
namespace {

using Json = nlohmann::json;

// A file's two parts; `binary` is empty but for .glb.
struct Container {
    std::string json;
    std::vector<unsigned char> binary;
};

uint32_t wordAt(std::span<const std::byte> bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, &bytes[offset], sizeof value);
    return value;
}

// Takes a binary container apart (glTF 2.0, 4.4); text is taken as it is.
Container openContainer(std::span<const std::byte> bytes, const std::string& name) {
    constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
    if (bytes.size() < 12 || wordAt(bytes, 0) != kMagic)
        return {std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), {}};
    if (wordAt(bytes, 4) != 2)
        throw Error(fmt::format("{}: is binary glTF {}: expected version 2", name, wordAt(bytes, 4)));
    if (wordAt(bytes, 8) > bytes.size())
        throw Error(fmt::format("{}: is truncated: expected {} bytes, found {}", name, wordAt(bytes, 8),
                                bytes.size()));
    Container container;
    for (size_t start = 12; start + 8 <= bytes.size();) {
        const size_t size = wordAt(bytes, start), kind = wordAt(bytes, start + 4);
        start += 8;
        if (size > bytes.size() - start)
            throw Error(fmt::format("{}: is truncated within a chunk of {} bytes", name, size));
        const auto* data = reinterpret_cast<const unsigned char*>(bytes.data()) + start;
        if (kind == kJson && container.json.empty()) container.json.assign(data, data + size);
        if (kind == kBinary && container.binary.empty()) container.binary.assign(data, data + size);
        start += size;
    }
    return container;
}

constexpr std::array<std::string_view, 9> kGeometry = {"asset",       "scene",   "scenes",
                                                       "nodes",       "meshes",  "accessors",
                                                       "bufferViews", "buffers", "extensionsRequired"};
constexpr std::array<std::string_view, 4> kLooks = {"materials", "textures", "images", "samplers"};

// Takes some members out of a document.
Json takeMembers(Json& document, std::span<const std::string_view> keys) {
    Json taken = Json::object();
    for (const std::string_view key : keys)
        if (const auto found = document.find(key); found != document.end())
            taken[std::string(key)] = std::move(*found);
    return taken;
}

std::string shorten(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 40);
}

void checkVersion(const Json& document, const std::string& name) {
    const auto asset = document.find("asset");
    const Json version =
        asset != document.end() && asset->is_object() ? asset->value("version", Json()) : Json();
    if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2."))
        throw Error(fmt::format("{}: expected glTF of asset version 2.0, found {}: export it as glTF 2.0",
                                name, shorten(version)));
}

// Leaves out what nobody reads, and throws for what the library would take for another number: it has
// defaults for those that are not whole or negative, and wraps large ones. `key` is that of the nearest
// member.
void checkGeometry(const std::string& key, Json& json, const std::string& name) {
    static constexpr std::string_view kSizes[] = {"byteLength", "byteOffset", "count"};
    static constexpr std::string_view kNumbers[] = {"attributes", "buffer",  "bufferView", "byteStride",
                                                    "children",   "indices", "material",   "mesh",
                                                    "mode",       "nodes",   "scene",      "componentType"};
    const auto isOneOf = [&](const auto& keys) { return std::ranges::find(keys, key) != std::end(keys); };
    if (json.is_object()) {
        for (const char* unread : {"extras", "targets", "extensions"}) json.erase(unread);
        for (auto& [member, value] : json.items())
            checkGeometry(key == "attributes" ? key : member, value, name);
    } else if (json.is_array()) {
        for (Json& value : json) checkGeometry(key, value, name);
    } else if (isOneOf(kNumbers) || isOneOf(kSizes)) {
        const bool isWhole =
            json.is_number_unsigned() && (isOneOf(kSizes) || json.get<uint64_t>() <= uint64_t(INT32_MAX));
        if (!isWhole)
            throw Error(
                fmt::format("{}: \"{}\": expected a whole number from 0 on, found {}: export the file again",
                            name, key, shorten(json)));
    }
}

// Throws if the file cannot be understood without an extension that changes geometry.
void checkExtensions(const Json& document, const std::string& name) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const auto& extension : *required) {
        const std::string text = extension.is_string() ? extension.get<std::string>() : extension.dump();
        if (!text.starts_with("KHR_materials_") && !text.starts_with("KHR_texture_") &&
            !text.starts_with("EXT_texture_") && text != "KHR_mesh_quantization" &&
            text != "KHR_lights_punctual" && text != "EXT_meshopt_compression")
            throw Error(
                fmt::format("{}: requires the glTF extension {}, which is not supported: export without it "
                            "(uncompressed)",
                            name, text));
    }
}

std::filesystem::path folderOrHere(const std::filesystem::path& folder) {
    return folder.empty() ? std::filesystem::path(".") : folder;
}

// Symbolic links count as what they lead to.
bool isFileInside(const std::filesystem::path& path, const std::filesystem::path& folder) {
    std::error_code failure, missing;
    const auto place = std::filesystem::canonical(path, missing);
    const auto relative = place.lexically_relative(std::filesystem::canonical(folder, failure));
    return !missing && !failure && !relative.empty() && *relative.begin() != ".." &&
           std::filesystem::is_regular_file(place, failure);
}

// The buffers of a document by the names under which the library asks for them: it reads no files itself.
constexpr const char* kBuffers = "buffers";
using Buffers = std::map<std::string, std::vector<unsigned char>>;

tinygltf::FsCallbacks callbacksOf(Buffers& buffers) {
    const auto exists = [](const std::string& path, void* data) {
        return static_cast<Buffers*>(data)->contains(path);
    };
    const auto read = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void* data) {
        *out = std::move(static_cast<Buffers*>(data)->at(path));
        return true;
    };
    return {exists, [](const std::string& path, void*) { return path; }, read,
            [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
            &buffers};
}

// The bytes of a buffer: in its address, in a file, or, of a .glb's first without an address, in the binary
// chunk, which may be padded.
std::vector<unsigned char> readBuffer(const Json& buffer, Container& container,
                                      const std::filesystem::path& folder, const std::string& place) {
    const std::string uri = gltfText(buffer, "uri", place);
    std::vector<unsigned char> bytes;
    if (uri.empty()) {
        bytes = std::exchange(container.binary, {});
    } else if (std::string type; tinygltf::IsDataURI(uri)) {
        tinygltf::DecodeDataURI(&bytes, type, uri, 0, false);
    } else {
        const std::vector<std::byte> file = readFile(findGltfFile(uri, folder, place));
        const auto* first = reinterpret_cast<const unsigned char*>(file.data());
        bytes.assign(first, first + file.size());
    }
    const auto length = buffer.find("byteLength");
    const size_t size = length != buffer.end() && length->is_number_unsigned() ? length->get<size_t>() : 0;
    if (bytes.size() < size || (bytes.size() > size && !uri.empty()))
        throw Error(
            fmt::format("{}: expected {} bytes by its byteLength, found {}: the file is truncated or corrupt",
                        place, size, bytes.size()));
    bytes.resize(size);
    return bytes;
}

tinygltf::Model readModel(Json document, const GltfPacking& packing, Container container,
                          const std::filesystem::path& folder, const std::string& name) {
    Buffers files;
    if (const auto buffers = document.find("buffers"); buffers != document.end() && buffers->is_array())
        for (size_t i = 0; i < buffers->size(); i++) {
            Json& buffer = (*buffers)[i];
            if (!buffer.is_object()) continue;
            const std::string place = fmt::format("{}: buffers[{}]", name, i);
            const bool isPlaceholder = packing.placeholders.contains(i);
            if (isPlaceholder) buffer["byteLength"] = 1; // TinyGLTF refuses an empty buffer
            files[fmt::format("{}/{}", kBuffers, i)] =
                isPlaceholder ? std::vector<unsigned char>(1) : readBuffer(buffer, container, folder, place);
            buffer["uri"] = fmt::format("{}", i);
        }
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(callbacksOf(files));
    reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string failure, warning;
    const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > std::numeric_limits<unsigned>::max())
        throw Error(fmt::format("{}: is too large", name));
    const bool isRead =
        reader.LoadASCIIFromString(&model, &failure, &warning, text.data(), unsigned(text.size()), kBuffers);
    if (!isRead || !failure.empty())
        throw Error(
            fmt::format("{}: is not valid glTF: {}", name,
                        failure.substr(0, std::min(failure.find_last_not_of('\n') + 1, size_t(400)))));
    unpackGltfViews(packing, model, name);
    return model;
}

// Replaces each %XX by the byte it stands for (RFC 3986).
std::string decodeUri(std::string_view uri) {
    std::string decoded;
    for (size_t i = 0; i < uri.size(); i++) {
        unsigned byte = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            decoded += char(byte);
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return decoded;
}

} // namespace

GltfDocument readGltfDocument(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                              const std::string& name) {
    Container container = openContainer(bytes, name);
    Json whole = parseJson(container.json, name, 64);
    if (!whole.is_object())
        throw Error(
            fmt::format("{}: is not valid glTF: expected an object, found {}", name, whole.type_name()));
    // The looks are not for the library, which indexes buffers by their numbers unchecked, and recurses into
    // extensions as deep as a file likes.
    Json geometry = takeMembers(whole, kGeometry), looks = takeMembers(whole, kLooks);
    checkVersion(geometry, name);
    checkExtensions(geometry, name);
    const GltfPacking packing = readGltfPacking(geometry);
    checkGeometry("", geometry, name);
    return {readModel(std::move(geometry), packing, std::move(container), folder, name), std::move(looks)};
}

std::filesystem::path findGltfFile(const std::string& uri, const std::filesystem::path& folder,
                                   const std::string& name) {
    // Joined as text: an absolute address must not replace the folder.
    const std::filesystem::path path = folderOrHere(folder).string() + "/" + decodeUri(uri);
    if (!isFileInside(path, folderOrHere(folder)))
        throw Error(fmt::format("{}: refers to \"{}\", which is no file in its folder or below: put it there",
                                name, uri.substr(0, 200)));
    return path;
}

} // namespace relume

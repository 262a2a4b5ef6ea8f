#include "engine/import/gltf_document.h"

#include "engine/base/error.h"
#include "engine/base/file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace relume {
namespace {

using Json = nlohmann::json;

// The name under which the binary chunk of a .glb is handed to the library.
constexpr std::string_view kBinaryChunk = "binary-chunk-of-this-file";

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

// Keeps of the document what geometry and looks need.
Json readJson(const std::string& text, const std::string& name) {
    const auto isOneOf = [](const auto& names, std::string_view key) {
        return std::find(names.begin(), names.end(), key) != names.end();
    };
    bool isLook = false; // whether the parser is inside of one of kLooks
    const auto keep = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > 64) throw Error(fmt::format("{}: is nested deeper than any glTF file", name));
        if (event != Json::parse_event_t::key) return true;
        const std::string& key = parsed.get_ref<const std::string&>();
        if (depth == 1) {
            isLook = isOneOf(kLooks, key);
            return isLook || isOneOf(kGeometry, key);
        }
        return key != "extras" && key != "targets" && (isLook || key != "extensions");
    };
    try {
        return Json::parse(text, keep);
    } catch (const Json::exception& failure) {
        throw Error(fmt::format("{}: is not valid glTF: {}", name, failure.what()));
    }
}

// Takes the looks out of a document. They are not for the library, which indexes buffers by their numbers
// unchecked, and recurses into extensions as deep as a file likes.
Json takeLooks(Json& document) {
    Json looks = Json::object();
    for (const std::string_view key : kLooks) {
        const auto found = document.find(key);
        if (found == document.end()) continue;
        looks[std::string(key)] = std::move(*found);
        document.erase(found);
    }
    return looks;
}

// Throws if the file cannot be understood without an extension that changes geometry.
void checkExtensions(const Json& document, const std::string& name) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const auto& extension : *required) {
        const std::string text = extension.is_string() ? extension.get<std::string>() : extension.dump();
        if (!text.starts_with("KHR_materials_") && !text.starts_with("KHR_texture_") &&
            !text.starts_with("EXT_texture_") && text != "KHR_mesh_quantization" &&
            text != "KHR_lights_punctual")
            throw Error(
                fmt::format("{}: requires the glTF extension {}, which is not supported: export without it "
                            "(uncompressed)",
                            name, text));
    }
}

std::filesystem::path folderOrHere(const std::filesystem::path& folder) {
    return folder.empty() ? std::filesystem::path(".") : folder;
}

bool isFileInside(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto relative = path.lexically_normal().lexically_relative(folder.lexically_normal());
    return !relative.empty() && *relative.begin() != ".." && std::filesystem::is_regular_file(path);
}

// What the library may read: the binary chunk, and files in the folder of the glTF file and below.
struct FileAccess {
    std::string folder;
    const std::vector<unsigned char>* binary;

    bool isBinary(const std::string& path) const { return path == folder + "/" + std::string(kBinaryChunk); }
    bool isInside(const std::string& path) const { return isFileInside(path, folder); }
};

tinygltf::FsCallbacks callbacksOf(FileAccess& access) {
    const auto exists = [](const std::string& path, void* data) {
        const auto& files = *static_cast<FileAccess*>(data);
        return files.isBinary(path) || files.isInside(path);
    };
    const auto read = [](std::vector<unsigned char>* out, std::string* failure, const std::string& path,
                         void* data) {
        const auto& files = *static_cast<FileAccess*>(data);
        if (files.isBinary(path)) {
            *out = *files.binary;
            return true;
        }
        try {
            const std::vector<std::byte> bytes = readFile(path);
            const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
            out->assign(first, first + bytes.size());
            return true;
        } catch (const Error& error) {
            *failure = error.what();
            return false;
        }
    };
    return {exists, [](const std::string& path, void*) { return path; }, read,
            [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
            &access};
}

tinygltf::Model readModel(Json document, Container container, const std::filesystem::path& folder,
                          const std::string& name) {
    // The first buffer of a .glb has no address: it is the binary chunk, without its padding.
    const auto buffers = document.find("buffers");
    if (!container.binary.empty() && buffers != document.end() && buffers->is_array() && !buffers->empty() &&
        buffers->front().is_object() && !buffers->front().contains("uri")) {
        buffers->front()["uri"] = kBinaryChunk;
        const auto length = buffers->front().find("byteLength");
        if (length != buffers->front().end() && length->is_number_unsigned())
            container.binary.resize(std::min(container.binary.size(), length->get<size_t>()));
    }
    FileAccess access{folderOrHere(folder).string(), &container.binary};
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(callbacksOf(access));
    reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string failure, warning;
    const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > std::numeric_limits<unsigned>::max())
        throw Error(fmt::format("{}: is too large", name));
    const bool isRead = reader.LoadASCIIFromString(&model, &failure, &warning, text.data(),
                                                   unsigned(text.size()), access.folder);
    if (!isRead || !failure.empty())
        throw Error(
            fmt::format("{}: is not valid glTF: {}", name,
                        failure.substr(0, std::min(failure.find_last_not_of('\n') + 1, size_t(400)))));
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
    Json document = readJson(container.json, name);
    checkExtensions(document, name);
    Json looks = document.is_object() ? takeLooks(document) : Json::object();
    return {readModel(std::move(document), std::move(container), folder, name), std::move(looks)};
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

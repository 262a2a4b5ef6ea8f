#include "engine/import/gltf_compression.h"

#include "engine/base/error.h"
#include "engine/import/gltf_json.h"

#include <fmt/core.h>
#include <iterator>
#include <meshoptimizer.h>
#include <span>
#include <vector>

namespace relume {
namespace {

using Json = nlohmann::json;

constexpr const char* kExtension = "EXT_meshopt_compression";

// The most bytes that a packed byte unfolds to: attributes that are all equal take two bits for 16 bytes.
constexpr size_t kMostRatio = 64;

constexpr size_t kLargestStride = 256;

struct PackedView {
    std::span<const unsigned char> bytes;
    size_t count, stride;
    std::string mode, filter;
};

size_t readSize(const Json& json, const char* key, const std::string& place) {
    const Json* found = findGltfMember(json, key, place);
    if (!found) return 0;
    if (!found->is_number_unsigned())
        throw Error(fmt::format("{}: \"{}\": expected a whole number from 0 on", place, key));
    return found->get<size_t>();
}

// Reads a description, checks it against the specification, and finds the bytes that it refers to.
PackedView readView(const Json& json, const tinygltf::Model& model, const std::string& place) {
    const size_t number = readSize(json, "buffer", place);
    if (number >= model.buffers.size())
        throw Error(fmt::format("{}: refers to buffer {}, but there are only {}", place, number,
                                model.buffers.size()));
    const std::span<const unsigned char> buffer = model.buffers[number].data;
    const size_t offset = readSize(json, "byteOffset", place), length = readSize(json, "byteLength", place);
    if (offset > buffer.size() || length > buffer.size() - offset)
        throw Error(
            fmt::format("{}: does not fit in its buffer of {} bytes: the file is truncated or corrupt", place,
                        buffer.size()));
    PackedView view{buffer.subspan(offset, length), readSize(json, "count", place),
                    readSize(json, "byteStride", place), gltfText(json, "mode", place),
                    gltfText(json, "filter", place)};
    if (view.filter.empty()) view.filter = "NONE";
    const size_t stride = view.stride;
    const bool isIndex = (view.mode == "TRIANGLES" && view.count % 3 == 0) || view.mode == "INDICES";
    const bool isAttribute =
        view.mode == "ATTRIBUTES" && stride > 0 && stride <= kLargestStride && stride % 4 == 0;
    const bool isFiltered = (view.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                            (view.filter == "QUATERNION" && stride == 8) || view.filter == "EXPONENTIAL";
    const bool isPlain = view.filter == "NONE";
    if (view.count == 0 ||
        (!(isIndex && isPlain && (stride == 2 || stride == 4)) && !(isAttribute && (isPlain || isFiltered))))
        throw Error(
            fmt::format("{}: mode \"{:.20}\", filter \"{:.20}\", stride {} and count {} are none that the "
                        "specification has: export the file again",
                        place, view.mode, view.filter, stride, view.count));
    return view;
}

using Decoder = int (*)(void*, size_t count, size_t stride, const unsigned char*, size_t);

Decoder findDecoder(const std::string& mode) {
    if (mode == "TRIANGLES") return meshopt_decodeIndexBuffer;
    if (mode == "INDICES") return meshopt_decodeIndexSequence;
    return meshopt_decodeVertexBuffer;
}

std::vector<unsigned char> unpack(const PackedView& view, const std::string& place) {
    std::vector<unsigned char> unpacked(view.count * view.stride);
    unsigned char* const data = unpacked.data();
    if (findDecoder(view.mode)(data, view.count, view.stride, view.bytes.data(), view.bytes.size()) != 0)
        throw Error(fmt::format("{}: cannot be unpacked: the file is truncated or corrupt", place));
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(data, view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, view.count, view.stride);
    return unpacked;
}

// Returns the extension's member of an object whose extensions may be anything, or null.
const Json* findExtension(const Json& object) {
    if (!object.is_object()) return nullptr;
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(kExtension);
    return found == extensions->end() ? nullptr : &*found;
}

} // namespace

GltfPacking readGltfPacking(const Json& document) {
    GltfPacking packing;
    static const Json kNone = Json::array();
    const auto elements = [&](const char* list) -> const Json& {
        const auto found = document.find(list);
        return found != document.end() && found->is_array() ? *found : kNone;
    };
    const Json &views = elements("bufferViews"), &buffers = elements("buffers");
    for (size_t i = 0; i < views.size(); i++)
        if (const Json* extension = findExtension(views[i])) packing.views[i] = *extension;
    // A binary file's chunk is the first buffer; others without an address have no bytes.
    for (size_t i = 0; i < buffers.size() && !packing.views.empty(); i++) {
        const Json* extension = findExtension(buffers[i]);
        const bool isFallback =
            extension && extension->is_object() && extension->value("fallback", Json()) == true;
        if (isFallback || (i > 0 && !buffers[i].contains("uri"))) packing.placeholders.insert(i);
    }
    return packing;
}

void unpackGltfViews(const GltfPacking& packing, tinygltf::Model& model, const std::string& name) {
    size_t most = 0;
    for (const tinygltf::Buffer& buffer : model.buffers) most += kMostRatio * buffer.data.size();
    std::vector<tinygltf::Buffer> unpacked;
    for (const auto& [number, json] : packing.views) {
        const std::string place = fmt::format("{}: bufferViews[{}]: {}", name, number, kExtension);
        const PackedView view = readView(json, model, place);
        // Views may share bytes, of which a small file would unfold to gigabytes.
        if (view.count > most / view.stride)
            throw Error(fmt::format("{}: unpacks to more than {} times the file's bytes: the file is corrupt",
                                    place, kMostRatio));
        most -= view.count * view.stride;
        tinygltf::BufferView& parent = model.bufferViews.at(number);
        parent.buffer = int(model.buffers.size() + unpacked.size());
        parent.byteOffset = 0;
        parent.byteLength = view.count * view.stride;
        unpacked.emplace_back().data = unpack(view, place);
    }
    model.buffers.insert(model.buffers.end(), std::make_move_iterator(unpacked.begin()),
                         std::make_move_iterator(unpacked.end()));
}

} // namespace relume

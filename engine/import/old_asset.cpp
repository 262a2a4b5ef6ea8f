#include "engine/import/old_asset.h"

#include "engine/base/error.h"
#include "engine/chunk/byte_stream.h"
#include "engine/import/json_object.h"
#include "engine/scene/factored_brdf.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr uint32_t kOldVersion = 2;
// Reads typed members of a JSON object; errors name the object.
class OldReader {
  public:
    OldReader(const OrderedJson& object, std::string where) : mObject(object), mWhere(std::move(where)) {
        if (!object.is_object())
            throw Error(fmt::format("{}: expected an object, found {}", mWhere, object.type_name()));
    }

    uint64_t whole(const char* key, uint64_t low, uint64_t high) const {
        const OrderedJson& value = member(key);
        if (!value.is_number_unsigned() || value.get<uint64_t>() < low || value.get<uint64_t>() > high)
            throw Error(
                fmt::format("{}: \"{}\": expected a whole number of {} to {}", mWhere, key, low, high));
        return value.get<uint64_t>();
    }

    int integer(const char* key, int low, int high) const {
        return int(whole(key, uint64_t(low), uint64_t(high)));
    }

    double number(const char* key) const {
        const OrderedJson& value = member(key);
        if (!value.is_number() ||
            !(std::abs(value.get<double>()) <= double(std::numeric_limits<float>::max())))
            throw Error(fmt::format("{}: \"{}\": expected a number", mWhere, key));
        return value.get<double>();
    }
    float real(const char* key) const { return float(number(key)); }

    std::string text(const char* key) const {
        const OrderedJson& value = member(key);
        if (!value.is_string()) throw Error(fmt::format("{}: \"{}\": expected text", mWhere, key));
        return value.get<std::string>();
    }

    bool boolean(const char* key) const {
        const OrderedJson& value = member(key);
        if (!value.is_boolean()) throw Error(fmt::format("{}: \"{}\": expected true or false", mWhere, key));
        return value.get<bool>();
    }

    bool has(const char* key) const { return mObject.contains(key); }

    OldReader object(const char* key) const { return {member(key), fmt::format("{}: \"{}\"", mWhere, key)}; }

    const OrderedJson& array(const char* key) const {
        const OrderedJson& value = member(key);
        if (!value.is_array()) throw Error(fmt::format("{}: \"{}\": expected an array", mWhere, key));
        return value;
    }

    const std::string& where() const { return mWhere; }

  private:
    const OrderedJson& member(const char* key) const {
        const auto found = mObject.find(key);
        if (found == mObject.end()) throw Error(fmt::format("{}: expected a member \"{}\"", mWhere, key));
        return *found;
    }

    const OrderedJson& mObject;
    std::string mWhere;
};

LayoutRecord readLayout(const OldReader& in) {
    LayoutRecord layout;
    if (in.has("wantedBytes")) layout.wantedBytes = in.number("wantedBytes");
    if (in.has("wantedError")) layout.wantedError = in.number("wantedError");
    layout.error = in.number("error");
    return layout;
}

void readKinds(const OldReader&, SparseTransport&) {}

void readKinds(const OldReader& in, BasisTransport& bases) {
    const OrderedJson& kinds = in.array("kinds");
    for (size_t i = 0; i < kinds.size() && i <= 3 * kMostTerms; i++) {
        const OldReader kind(kinds[i], fmt::format("{}: kind {}", in.where(), i));
        bases.kinds.push_back({uint32_t(kind.integer("term", 0, kMostTerms - 1)),
                               {kind.real("red"), kind.real("green"), kind.real("blue")}});
    }
}

void readSet(const OldReader& in, uint64_t vertices, AssetMeta& meta) {
    MaterialSet set;
    set.brdf.terms = in.integer("terms", 1, kMostTerms);
    set.brdf.layers = in.integer("layers", 1, kLargestLayers);
    set.brdf.size = in.integer("mapSize", kSmallestMap, kLargestMap);
    const std::string mapping = in.text("mapping");
    if (!diskMappingFromName(mapping))
        throw Error(fmt::format("{}: \"mapping\": \"{}\" is unknown", in.where(), mapping));
    set.brdf.mapping = *diskMappingFromName(mapping);
    const std::string layout = in.has("layout") ? in.text("layout") : layoutName(TransportLayout::Rows);
    set.transport =
        emptyTransport(readLayoutName(layout, in.where()), uint32_t(vertices), uint32_t(set.brdf.terms));
    std::visit([&](auto& own) { readKinds(in, own); }, set.transport);
    const OrderedJson& materials = in.array("materials");
    for (size_t i = 0; i < materials.size(); i++) {
        const OldReader material(materials[i], fmt::format("{}: material {}", in.where(), i));
        set.materials.push_back({material.text("name"), material.text("description"),
                                 material.integer("layer", 0, kLargestLayers), material.boolean("base")});
    }
    meta.sizes.setEntries.push_back(in.whole("entries", 0, kMostMetaEntries));
    meta.asset.parts.back().sets.push_back(std::move(set));
}

Texture textureOf(const OldReader& in) {
    Texture texture;
    texture.width = in.integer("width", 1, kLongestTextureSide);
    texture.height = in.integer("height", 1, kLongestTextureSide);
    texture.srgb = in.boolean("srgb");
    return texture;
}

void readPart(const OldReader& in, AssetMeta& meta) {
    AssetPart& part = meta.asset.parts.emplace_back();
    AssetPartSizes sizes;
    part.name = in.text("name");
    sizes.vertices = in.whole("vertices", 1, kMostMetaCount);
    sizes.triangles = in.whole("triangles", 1, kMostMetaCount);
    sizes.uvs = in.boolean("uvs") ? sizes.vertices : 0;
    sizes.colors = in.boolean("colors") ? sizes.vertices : 0;
    sizes.tangents = in.has("tangents") && in.boolean("tangents") ? sizes.vertices : 0;
    part.paintedByColors = in.boolean("paintedByColors");
    if (in.has("baseColor")) part.baseColor = textureOf(in.object("baseColor"));
    if (in.has("materialMap")) part.materialMap = textureOf(in.object("materialMap"));
    meta.sizes.parts.push_back(sizes);
    const OrderedJson& sets = in.array("sets");
    for (size_t i = 0; i < sets.size(); i++)
        readSet({sets[i], fmt::format("{}: set {}", in.where(), i)}, sizes.vertices, meta);
}

OrderedJson parseBounded(std::string_view text, const std::string& where) {
    if (isJsonDeeper(text, kRecordDepth)) throw Error(fmt::format("{}: nested too deep", where));
    try {
        return OrderedJson::parse(text);
    } catch (const OrderedJson::exception& failure) {
        throw Error(fmt::format("{}: is not JSON: {}", where, failure.what()));
    }
}

AssetMeta decodeOldMeta(std::string_view text, const std::string& name) {
    const std::string where = name + ": chunk META";
    const OrderedJson json = parseBounded(text, where);
    const OldReader in(json, where);
    AssetMeta meta;
    meta.asset.faceSize = in.integer("faceSize", kSmallestFace, kLargestFace);
    meta.asset.visibilitySize = in.integer("visibilitySize", kSmallestVisibility, kLargestVisibility);
    meta.asset.coefficients = in.integer("coefficients", 1, 6 * kLargestFace * kLargestFace);
    meta.asset.transportSamples = in.integer("transportSamples", 1, kLargestVisibility * kLargestVisibility);
    meta.asset.visibilityOffset = in.real("visibilityOffset");
    meta.asset.quantizationError = in.real("quantisationError");
    meta.asset.truncationError = in.real("truncationError");
    if (in.has("layout")) meta.asset.layout = readLayout(in.object("layout"));
    const OldReader occluder = in.object("occluder");
    meta.sizes.occluderVertices = occluder.whole("vertices", 0, kMostMetaCount);
    meta.sizes.occluderTriangles = occluder.whole("triangles", 0, kMostMetaCount);
    const OrderedJson& parts = in.array("parts");
    for (size_t i = 0; i < parts.size(); i++)
        readPart({parts[i], fmt::format("{}: part {}", where, i)}, meta);
    const OldReader provenance = in.object("provenance");
    meta.asset.provenance = {provenance.text("program"), provenance.text("device"),
                             provenance.text("options"), provenance.text("inputs")};
    if (in.has("visibilityKey")) {
        meta.visibilityKey = in.text("visibilityKey");
        if (meta.visibilityKey.size() != kVisibilityKeyDigits ||
            meta.visibilityKey.find_first_not_of("0123456789abcdef") != std::string::npos)
            throw Error(fmt::format("{}: \"visibilityKey\": expected {} hexadecimal digits", where,
                                    kVisibilityKeyDigits));
    }
    if (provenance.has("bakedShare")) meta.asset.provenance.bakedShare = provenance.real("bakedShare");
    return meta;
}

} // namespace

bool isOldAsset(std::span<const std::byte> bytes) {
    constexpr size_t kMagicBytes = 8;
    if (bytes.size() < kMagicBytes + sizeof(uint32_t)) return false;
    return hasAssetMagic(bytes) && ByteReader(bytes.subspan(kMagicBytes), "").get<uint32_t>() == kOldVersion;
}

std::vector<std::byte> updateAsset(std::span<const std::byte> bytes, const std::string& name) {
    const ChunkFile old(sourceOf(bytes), name, kOldVersion);
    const auto runs = old.find(kMeta, kWholeFile);
    if (runs.size() != 1 || runs[0].rawSize > kLargestMeta)
        throw Error(fmt::format("{}: expected one chunk META of at most {} bytes", name, kLargestMeta));
    const std::vector<std::byte> text = old.load(runs[0]);
    const AssetMeta meta = decodeOldMeta({reinterpret_cast<const char*>(text.data()), text.size()}, name);
    ChunkWriter file;
    for (const ChunkEntry& entry : old.entries()) {
        if (entry.tag == kMeta)
            file.add(kMeta, kWholeFile, 0, encodeMeta(meta.asset, meta.sizes, meta.visibilityKey));
        else
            file.addStored(entry, [&old, entry] { return old.loadStored(entry); });
    }
    return file.finish();
}

} // namespace relume

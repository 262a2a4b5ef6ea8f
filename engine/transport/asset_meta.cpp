#include "engine/transport/asset_meta.h"

#include "engine/base/error.h"
#include "engine/transport/asset_check.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace relume {

using Json = nlohmann::ordered_json;

namespace {

constexpr uint64_t kAnyCount = 0xffffffff;          // of vertices or triangles
constexpr uint64_t kAnyEntries = uint64_t(1) << 48; // of transport

// A JSON object with a name for errors; reads typed members.
class Reader {
  public:
    Reader(const Json& object, std::string where) : mObject(object), mWhere(std::move(where)) {
        if (!object.is_object()) throw Error("{}: expected an object, found {}", mWhere, object.type_name());
    }

    uint64_t whole(const char* key, uint64_t low, uint64_t high) const {
        const Json& value = member(key);
        if (!value.is_number_unsigned() || value.get<uint64_t>() < low || value.get<uint64_t>() > high)
            throw Error("{}: \"{}\": expected a whole number of {} to {}", mWhere, key, low, high);
        return value.get<uint64_t>();
    }

    int integer(const char* key, int low, int high) const {
        return int(whole(key, uint64_t(low), uint64_t(high)));
    }

    double number(const char* key) const {
        const Json& value = member(key);
        if (!value.is_number() ||
            !(std::abs(value.get<double>()) <= double(std::numeric_limits<float>::max())))
            throw Error("{}: \"{}\": expected a number", mWhere, key);
        return value.get<double>();
    }
    float real(const char* key) const { return float(number(key)); }

    std::string text(const char* key) const {
        const Json& value = member(key);
        if (!value.is_string()) throw Error("{}: \"{}\": expected text", mWhere, key);
        return value.get<std::string>();
    }

    bool boolean(const char* key) const {
        const Json& value = member(key);
        if (!value.is_boolean()) throw Error("{}: \"{}\": expected true or false", mWhere, key);
        return value.get<bool>();
    }

    bool has(const char* key) const { return mObject.contains(key); }

    Reader object(const char* key) const { return {member(key), fmt::format("{}: \"{}\"", mWhere, key)}; }

    const Json& array(const char* key) const {
        const Json& value = member(key);
        if (!value.is_array()) throw Error("{}: \"{}\": expected an array", mWhere, key);
        return value;
    }

    const std::string& where() const { return mWhere; }

  private:
    const Json& member(const char* key) const {
        const auto found = mObject.find(key);
        if (found == mObject.end()) throw Error("{}: expected a member \"{}\"", mWhere, key);
        return *found;
    }

    const Json& mObject;
    std::string mWhere;
};

Json setJson(const MaterialSet& set, uint64_t entries) {
    Json materials = Json::array();
    for (const AssetMaterial& material : set.materials)
        materials.push_back({{"name", material.name},
                             {"description", material.description},
                             {"layer", material.layer},
                             {"base", material.hasBase}});
    Json json = {{"materials", materials},
                 {"terms", set.brdf.terms},
                 {"layers", set.brdf.layers},
                 {"mapSize", set.brdf.size},
                 {"mapping", diskMappingName(set.brdf.mapping)},
                 {"layout", layoutName(layoutOf(set.transport))},
                 {"entries", entries}};
    if (const auto* bases = std::get_if<BasisTransport>(&set.transport)) {
        json["kinds"] = Json::array();
        for (const auto& [term, color] : bases->kinds)
            json["kinds"].push_back(
                {{"term", term}, {"red", color.x}, {"green", color.y}, {"blue", color.z}});
    }
    return json;
}

Json layoutJson(const LayoutRecord& layout) {
    Json json = Json::object();
    if (layout.wantedBytes) json["wantedBytes"] = *layout.wantedBytes;
    if (layout.wantedError) json["wantedError"] = *layout.wantedError;
    json["error"] = layout.error;
    return json;
}

LayoutRecord readLayout(const Reader& in) {
    LayoutRecord layout;
    if (in.has("wantedBytes")) layout.wantedBytes = in.number("wantedBytes");
    if (in.has("wantedError")) layout.wantedError = in.number("wantedError");
    layout.error = in.number("error");
    return layout;
}

Json textureJson(const Texture& texture) {
    return {{"width", texture.width}, {"height", texture.height}, {"srgb", texture.srgb}};
}

// Takes the entries of the part's sets off the front of `setEntries`.
Json partJson(const AssetPart& part, std::span<const uint64_t>& setEntries) {
    Json json = {{"name", part.name},
                 {"vertices", part.mesh.vertexCount()},
                 {"triangles", part.mesh.triangleCount()},
                 {"uvs", !part.mesh.uvs.empty()},
                 {"colors", !part.mesh.colors.empty()},
                 {"paintedByColors", part.paintedByColors}};
    if (!part.mesh.tangents.empty()) json["tangents"] = true;
    if (part.baseColor) json["baseColor"] = textureJson(*part.baseColor);
    if (part.materialMap) json["materialMap"] = textureJson(*part.materialMap);
    json["sets"] = Json::array();
    for (const MaterialSet& set : part.sets) {
        json["sets"].push_back(setJson(set, setEntries.front()));
        setEntries = setEntries.subspan(1);
    }
    return json;
}

void readSet(const Reader& in, uint64_t vertices, AssetMeta& meta) {
    MaterialSet set;
    set.brdf.terms = in.integer("terms", 1, kLargestTerms);
    set.brdf.layers = in.integer("layers", 1, kLargestLayers);
    set.brdf.size = in.integer("mapSize", kSmallestMap, kLargestMap);
    const std::string mapping = in.text("mapping");
    if (!diskMappingFromName(mapping)) throw Error("{}: \"mapping\": \"{}\" is unknown", in.where(), mapping);
    set.brdf.mapping = *diskMappingFromName(mapping);
    const std::string layout = in.has("layout") ? in.text("layout") : layoutName(TransportLayout::Rows);
    if (!layoutFromName(layout)) throw Error("{}: \"layout\": \"{}\" is unknown", in.where(), layout);
    set.transport = emptyTransport(*layoutFromName(layout), uint32_t(vertices), uint32_t(set.brdf.terms));
    if (auto* bases = std::get_if<BasisTransport>(&set.transport)) {
        const Json& kinds = in.array("kinds");
        for (size_t i = 0; i < kinds.size() && i <= 3 * kLargestTerms; i++) {
            const Reader kind(kinds[i], fmt::format("{}: kind {}", in.where(), i));
            bases->kinds.push_back({uint32_t(kind.integer("term", 0, kLargestTerms - 1)),
                                    {kind.real("red"), kind.real("green"), kind.real("blue")}});
        }
    }
    const Json& materials = in.array("materials");
    for (size_t i = 0; i < materials.size(); i++) {
        const Reader material(materials[i], fmt::format("{}: material {}", in.where(), i));
        set.materials.push_back({material.text("name"), material.text("description"),
                                 material.integer("layer", 0, kLargestLayers), material.boolean("base")});
    }
    meta.setEntries.push_back(in.whole("entries", 0, kAnyEntries));
    meta.asset.parts.back().sets.push_back(std::move(set));
}

Texture textureOf(const Reader& in) {
    Texture texture;
    texture.width = in.integer("width", 1, kLongestTextureSide);
    texture.height = in.integer("height", 1, kLongestTextureSide);
    texture.srgb = in.boolean("srgb");
    return texture;
}

void readPart(const Reader& in, AssetMeta& meta) {
    AssetPart& part = meta.asset.parts.emplace_back();
    AssetPartSizes sizes;
    part.name = in.text("name");
    sizes.vertices = in.whole("vertices", 1, kAnyCount);
    sizes.triangles = in.whole("triangles", 1, kAnyCount);
    sizes.uvs = in.boolean("uvs") ? sizes.vertices : 0;
    sizes.colors = in.boolean("colors") ? sizes.vertices : 0;
    sizes.tangents = in.has("tangents") && in.boolean("tangents") ? sizes.vertices : 0;
    part.paintedByColors = in.boolean("paintedByColors");
    if (in.has("baseColor")) part.baseColor = textureOf(in.object("baseColor"));
    if (in.has("materialMap")) part.materialMap = textureOf(in.object("materialMap"));
    meta.sizes.push_back(sizes);
    const Json& sets = in.array("sets");
    for (size_t i = 0; i < sets.size(); i++)
        readSet({sets[i], fmt::format("{}: set {}", in.where(), i)}, sizes.vertices, meta);
}

Json parseBounded(std::string_view text, const std::string& where) {
    const auto bound = [&](int depth, Json::parse_event_t, Json&) {
        if (size_t(depth) > kLargestMetaDepth) throw Error("{}: nested too deep", where);
        return true;
    };
    try {
        return Json::parse(text.begin(), text.end(), bound);
    } catch (const Json::exception& failure) {
        throw Error("{}: is not JSON: {}", where, failure.what());
    }
}

} // namespace

std::string encodeMeta(const Asset& asset, std::span<const uint64_t> setEntries,
                       const std::string& visibilityKey) {
    Json parts = Json::array();
    for (const AssetPart& part : asset.parts) parts.push_back(partJson(part, setEntries));
    Json meta = {
        {"faceSize", asset.faceSize},
        {"visibilitySize", asset.visibilitySize},
        {"coefficients", asset.coefficients},
        {"transportSamples", asset.transportSamples},
        {"visibilityOffset", asset.visibilityOffset},
        {"quantisationError", asset.quantisationError},
        {"truncationError", asset.truncationError},
        {"occluder",
         {{"vertices", asset.occluder.vertexCount()}, {"triangles", asset.occluder.triangleCount()}}},
        {"parts", parts},
        {"provenance",
         {{"program", asset.provenance.program},
          {"device", asset.provenance.device},
          {"options", asset.provenance.options},
          {"inputs", asset.provenance.inputs}}}};
    if (asset.layout) meta["layout"] = layoutJson(*asset.layout);
    if (!visibilityKey.empty()) meta["visibilityKey"] = visibilityKey;
    const std::optional<float> share = asset.provenance.bakedShare;
    if (share) meta["provenance"]["bakedShare"] = *share;
    std::string text = meta.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > kLargestMeta)
        throw Error(
            "names, materials and provenance take {} bytes, more than the {} that a bake can hold; use "
            "fewer or shorter ones",
            text.size(), kLargestMeta);
    return text;
}

AssetMeta decodeMeta(std::string_view text, const std::string& name) {
    const std::string where = name + ": chunk META";
    const Json json = parseBounded(text, where);
    const Reader in(json, where);
    AssetMeta meta;
    meta.asset.faceSize = in.integer("faceSize", kSmallestFace, kLargestFace);
    meta.asset.visibilitySize = in.integer("visibilitySize", kSmallestFace, kLargestVisibility);
    meta.asset.coefficients = in.integer("coefficients", 1, 6 * kLargestFace * kLargestFace);
    meta.asset.transportSamples = in.integer("transportSamples", 1, kLargestVisibility * kLargestVisibility);
    meta.asset.visibilityOffset = in.real("visibilityOffset");
    meta.asset.quantisationError = in.real("quantisationError");
    meta.asset.truncationError = in.real("truncationError");
    if (in.has("layout")) meta.asset.layout = readLayout(in.object("layout"));
    const Reader occluder = in.object("occluder");
    meta.occluderVertices = occluder.whole("vertices", 0, kAnyCount);
    meta.occluderTriangles = occluder.whole("triangles", 0, kAnyCount);
    const Json& parts = in.array("parts");
    for (size_t i = 0; i < parts.size(); i++)
        readPart({parts[i], fmt::format("{}: part {}", where, i)}, meta);
    const Reader provenance = in.object("provenance");
    meta.asset.provenance = {provenance.text("program"), provenance.text("device"),
                             provenance.text("options"), provenance.text("inputs")};
    if (in.has("visibilityKey")) {
        meta.visibilityKey = in.text("visibilityKey");
        if (meta.visibilityKey.size() != kVisibilityKeyDigits ||
            meta.visibilityKey.find_first_not_of("0123456789abcdef") != std::string::npos)
            throw Error("{}: \"visibilityKey\": expected {} hexadecimal digits", where, kVisibilityKeyDigits);
    }
    if (provenance.has("bakedShare")) meta.asset.provenance.bakedShare = provenance.real("bakedShare");
    return meta;
}

} // namespace relume

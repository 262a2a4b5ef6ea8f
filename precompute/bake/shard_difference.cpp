#include "precompute/bake/shard_difference.h"

#include "engine/import/json_object.h"
#include "engine/transport/asset_arrays.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <set>

namespace relume {

namespace {

using Json = nlohmann::json;

// Returns a file's text for a message: short and on one line.
std::string quoted(const std::string& text) {
    constexpr size_t kMost = 120;
    std::string shown = "\"";
    for (char letter : text.substr(0, kMost))
        shown += static_cast<unsigned char>(letter) < 32 || letter == 127 ? ' ' : letter;
    return shown + (text.size() > kMost ? "…\"" : "\"");
}

std::string pair(const std::string& what, const std::string& first, const std::string& other) {
    return fmt::format("{}: {}, not {}", what, quoted(other), quoted(first));
}

// Returns null unless the text is JSON that can be compared: an array or object of flat values or flat
// objects.
Json parseFlat(const std::string& text) {
    constexpr int kDeepest = 2;
    if (isJsonDeeper(text, kDeepest)) return {};
    const Json json = Json::parse(text, nullptr, false);
    return json.is_discarded() ? Json() : json;
}

std::string textOf(const Json& object, const std::string& key) {
    if (!object.is_object() || !object.contains(key)) return "nothing";
    const Json& value = object[key];
    return value.is_string() ? value.get<std::string>()
                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void compareOptions(const Provenance& first, const Provenance& other, std::vector<std::string>& found) {
    if (first.options == other.options) return;
    const Json a = parseFlat(first.options), b = parseFlat(other.options);
    std::set<std::string> keys;
    for (const Json& json : {a, b})
        if (json.is_object())
            for (const auto& [key, value] : json.items()) keys.insert(key);
    const size_t before = found.size();
    for (const std::string& key : keys)
        if (textOf(a, key) != textOf(b, key))
            found.push_back(pair("option " + quoted(key), textOf(a, key), textOf(b, key)));
    if (found.size() == before) found.push_back(pair("options", first.options, other.options));
}

void compareInputs(const Provenance& first, const Provenance& other, std::vector<std::string>& found) {
    if (first.inputs == other.inputs) return;
    const Json a = parseFlat(first.inputs), b = parseFlat(other.inputs);
    const size_t before = found.size();
    for (size_t i = 0; a.is_array() && b.is_array() && i < std::max(a.size(), b.size()); i++) {
        const Json none, &one = i < a.size() ? a[i] : none, &two = i < b.size() ? b[i] : none;
        if (one == two) continue;
        const std::string file = textOf(two, "file");
        if (textOf(one, "file") != file)
            found.push_back(pair("input", textOf(one, "file"), file));
        else
            found.push_back(
                fmt::format("input {}: its {}", quoted(file),
                            textOf(one, "hash") == textOf(two, "hash") ? "brush rotation" : "content"));
    }
    if (found.size() == before) found.push_back(pair("inputs", first.inputs, other.inputs));
}

std::string materialsOf(const Asset& asset) {
    std::string all;
    for (const AssetPart& part : asset.parts) {
        all += (all.empty() ? "" : "; ") + part.name + ":";
        for (const MaterialSet& set : part.sets)
            for (const AssetMaterial& material : set.materials) all += " " + material.name;
    }
    return all;
}

bool sameDescriptions(const Asset& first, const Asset& other) {
    const auto all = [](const Asset& asset) {
        std::vector<std::string> texts;
        for (const AssetPart& part : asset.parts)
            for (const MaterialSet& set : part.sets)
                for (const AssetMaterial& material : set.materials) texts.push_back(material.description);
        return texts;
    };
    return all(first) == all(other);
}

// Compares arrays that differ although they come from the same inputs and options.
void compareArrays(const ShardFile& first, const ShardFile& other, std::vector<std::string>& found) {
    const auto differ = [&](std::initializer_list<ChunkTag> tags) {
        const auto checksums = [&](const ShardFile& file) {
            std::vector<std::pair<ChunkTag, uint64_t>> sums;
            for (const ChunkEntry& entry : file.chunks().entries())
                if (std::ranges::find(tags, entry.tag) != tags.end())
                    sums.emplace_back(entry.tag, entry.checksum);
            return sums;
        };
        return checksums(first) != checksums(other);
    };
    if (differ({kPositions, kNormals, kTriangles, kUvs, kColors, kTangents})) found.push_back("the meshes");
    if (differ({kBaseColor, kMaterialMap, kNormalMap, kEmissionMap})) found.push_back("the textures");
    if (differ({kOccluderPositions, kOccluderTriangles})) found.push_back("the occluder");
    if (differ({kLightMaps, kViewMaps, kEigenvalues})) found.push_back("the materials' factors");
}

} // namespace

std::string describeDifference(const ShardFile& first, const ShardFile& other) {
    const Asset &a = first.meta().asset, &b = other.meta().asset;
    std::vector<std::string> found;
    if (a.provenance.program != b.provenance.program)
        found.push_back(pair("program", a.provenance.program, b.provenance.program));
    if (a.provenance.device != b.provenance.device)
        found.push_back(pair("device", a.provenance.device, b.provenance.device));
    compareOptions(a.provenance, b.provenance, found);
    compareInputs(a.provenance, b.provenance, found);
    if (materialsOf(a) != materialsOf(b))
        found.push_back(pair("materials", materialsOf(a), materialsOf(b)));
    else if (!sameDescriptions(a, b))
        found.push_back("materials: what they are made of");
    if (found.empty()) compareArrays(first, other, found);
    if (found.empty()) found.push_back(pair("identity", first.identity(), other.identity()));

    constexpr size_t kNamed = 6;
    std::string text;
    for (size_t i = 0; i < std::min(found.size(), kNamed); i++) text += (i == 0 ? "" : "; ") + found[i];
    return text + (found.size() > kNamed ? "; …" : "");
}

} // namespace relume

// Files of format version 2, as programs before wrote them.
#pragma once

#include "tests/support/asset_sample.h"

#include <nlohmann/json.hpp>

namespace relume::test {

using OrderedJson = nlohmann::ordered_json;

inline OrderedJson setJson(const MaterialSet& set, uint64_t entries) {
    OrderedJson materials = OrderedJson::array();
    for (const AssetMaterial& material : set.materials)
        materials.push_back({{"name", material.name},
                             {"description", material.description},
                             {"layer", material.layer},
                             {"base", material.hasBase}});
    OrderedJson json = {{"materials", materials},
                        {"terms", set.brdf.terms},
                        {"layers", set.brdf.layers},
                        {"mapSize", set.brdf.size},
                        {"mapping", diskMappingName(set.brdf.mapping)},
                        {"layout", layoutName(layoutOf(set.transport))},
                        {"entries", entries}};
    if (const auto* bases = std::get_if<BasisTransport>(&set.transport)) {
        json["kinds"] = OrderedJson::array();
        for (const auto& [term, color] : bases->kinds)
            json["kinds"].push_back(
                {{"term", term}, {"red", color.x}, {"green", color.y}, {"blue", color.z}});
    }
    return json;
}

inline OrderedJson layoutJson(const LayoutRecord& layout) {
    OrderedJson json = OrderedJson::object();
    if (layout.wantedBytes) json["wantedBytes"] = *layout.wantedBytes;
    if (layout.wantedError) json["wantedError"] = *layout.wantedError;
    json["error"] = layout.error;
    return json;
}

inline OrderedJson textureJson(const Texture& texture) {
    return {{"width", texture.width}, {"height", texture.height}, {"srgb", texture.srgb}};
}

// Takes the entries of the part's sets off the front of `setEntries`.
inline OrderedJson partJson(const AssetPart& part, std::span<const uint64_t>& setEntries) {
    OrderedJson json = {{"name", part.name},
                        {"vertices", part.mesh.vertexCount()},
                        {"triangles", part.mesh.triangleCount()},
                        {"uvs", !part.mesh.uvs.empty()},
                        {"colors", !part.mesh.colors.empty()},
                        {"paintedByColors", part.paintedByColors}};
    if (!part.mesh.tangents.empty()) json["tangents"] = true;
    if (part.baseColor) json["baseColor"] = textureJson(*part.baseColor);
    if (part.materialMap) json["materialMap"] = textureJson(*part.materialMap);
    json["sets"] = OrderedJson::array();
    for (const MaterialSet& set : part.sets) {
        json["sets"].push_back(setJson(set, setEntries.front()));
        setEntries = setEntries.subspan(1);
    }
    return json;
}

inline std::string oldMeta(const Asset& asset, std::span<const uint64_t> setEntries) {
    OrderedJson parts = OrderedJson::array();
    for (const AssetPart& part : asset.parts) parts.push_back(partJson(part, setEntries));
    OrderedJson meta = {
        {"faceSize", asset.faceSize},
        {"visibilitySize", asset.visibilitySize},
        {"coefficients", asset.coefficients},
        {"transportSamples", asset.transportSamples},
        {"visibilityOffset", asset.visibilityOffset},
        {"quantisationError", asset.quantizationError},
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
    const std::optional<float> share = asset.provenance.bakedShare;
    if (share) meta["provenance"]["bakedShare"] = *share;
    return meta.dump();
}

// `asset` has no residual.
inline std::vector<std::byte> oldFileOf(const Asset& asset) {
    std::vector<uint64_t> setEntries;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) setEntries.push_back(entriesOf(set.transport));
    const std::string meta = oldMeta(asset, setEntries);
    std::vector<RawChunk> chunks = chunksOf(encodeAsset(asset));
    const auto text = std::as_bytes(std::span(meta));
    chunks[0].raw.assign(text.begin(), text.end());
    std::vector<std::byte> bytes = fileOf(chunks);
    poke(bytes, 8, 2, 4);
    reseal(bytes);
    return bytes;
}

} // namespace relume::test

#include "engine/import/asset_info.h"

#include "engine/chunk/chunk_file.h"
#include "engine/import/json_object.h"
#include "engine/transport/asset_meta.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace relume {

using OrderedJson = nlohmann::ordered_json;

namespace {

// Returns parsed JSON if the text is JSON of small depth, else the text itself. Printing recurses, so depth
// is limited.
OrderedJson jsonOrText(const std::string& text) {
    if (isJsonDeeper(text, kRecordDepth)) return text;
    const OrderedJson json = OrderedJson::parse(text, nullptr, false);
    return json.is_discarded() ? OrderedJson(text) : json;
}

double ratio(uint64_t numerator, uint64_t denominator) {
    return denominator == 0 ? 0.0 : double(numerator) / double(denominator);
}

OrderedJson describeSet(const MaterialSet& set) {
    OrderedJson eigenvalues = OrderedJson::array(), materials = OrderedJson::array();
    for (const auto& channels : set.brdf.eigenvalues) eigenvalues.push_back(channels);
    for (const AssetMaterial& material : set.materials)
        materials.push_back({{"name", material.name},
                             {"brdf", jsonOrText(material.description)},
                             {"textured_base", material.hasBase}});
    return {{"materials", materials},
            {"terms", set.brdf.terms},
            {"map_size", set.brdf.size},
            {"mapping", diskMappingName(set.brdf.mapping)},
            {"eigenvalues", eigenvalues},
            {"residual", set.residual != nullptr},
            {"layout", layoutName(layoutOf(set.transport))},
            {"bytes_per_vertex", ratio(bytesOf(set.transport), verticesOf(set.transport))}};
}

OrderedJson describePart(const AssetPart& part) {
    OrderedJson json = {
        {"name", part.name}, {"vertices", part.mesh.vertexCount()}, {"triangles", part.mesh.triangleCount()}};
    if (part.baseColor) json["base_color"] = {part.baseColor->width, part.baseColor->height};
    if (part.materialMap) json["material_map"] = {part.materialMap->width, part.materialMap->height};
    if (part.paintedByColors) json["material_map"] = "colors";
    if (part.tintedByColors) json["tinted_by_colors"] = true;
    const SurfaceDetail& detail = part.detail;
    if (detail.normalMap) json["normal_map"] = {detail.normalMap->width, detail.normalMap->height};
    if (detail.emission != vec3(0))
        json["emission"] = {detail.emission.x, detail.emission.y, detail.emission.z};
    if (detail.emissionMap) json["emission_map"] = {detail.emissionMap->width, detail.emissionMap->height};
    if (!part.mesh.tangents.empty()) json["tangents"] = true;
    json["sets"] = OrderedJson::array();
    for (const MaterialSet& set : part.sets) json["sets"].push_back(describeSet(set));
    return json;
}

std::string describeSamples(int samples) {
    switch (samples) {
    case 1:
        return "one evaluation per lighting texel, an approximation";
    case 4:
        return "four evaluations per lighting texel, one per quadrant, an approximation";
    default:
        return fmt::format("{} evaluations per lighting texel", samples);
    }
}

std::string describeLayout(const SparseTransport&) {
    return "rows, 11, 11 and 10 bits for red, green and blue";
}

std::string describeLayout(const BasisTransport&) {
    return fmt::format("bases, {} vertices share basis vectors; 8 bits for these and for weights",
                       kBasisVertices);
}

// Returns the value of an option that the bake recorded, or null.
OrderedJson optionOf(const Asset& asset, const char* key) {
    const OrderedJson options = jsonOrText(asset.provenance.options);
    return options.is_object() && options.contains(key) ? options[key] : OrderedJson();
}

// Describes interpolation between vertices by the record of refinement, which may be null.
std::string describeInterpolation(const OrderedJson& record) {
    const auto number = [&](const char* key) {
        return record.is_object() && record.contains(key) && record[key].is_number()
                   ? record[key].get<double>()
                   : -1;
    };
    const double error = number("error"), from = number("start_vertices"), to = number("vertices");
    if (error < 0 || from < 0 || to < 0) return "interpolation between vertices: linear, of unknown error";
    const bool isAuto = record.contains("auto") && record["auto"] == true;
    return fmt::format(
        "interpolation between vertices: {:.2f} % of reflected light{} as estimated, meshes refined "
        "from {:.0f} to {:.0f} vertices",
        100 * error, isAuto ? " of the parts that came coarse" : "", from, to);
}

std::string describeVisibility(const Asset& asset) {
    const OrderedJson triangles = optionOf(asset, "occluder_triangles");
    const std::string occluder =
        !triangles.is_number() ? "an unknown occluder"
        : triangles > 0 ? fmt::format("a model simplified to {} triangles", asset.occluder.triangleCount())
                        : "all triangles";
    const OrderedJson method = optionOf(asset, "visibility");
    return fmt::format("visibility: {}, in 6 x {}² directions, taken {:g} above each vertex, of {}",
                       method == "raster"   ? "drawn"
                       : method == "traced" ? "traced"
                                            : "found in an unknown way",
                       asset.visibilitySize, asset.visibilityOffset, occluder);
}

// Describes the factorization and which values of f the terms of all sets were computed from.
std::string describeTerms(const Asset& asset) {
    const OrderedJson method = optionOf(asset, "factorization");
    if (!method.is_string()) return "BRDF terms: of an unknown factorization";
    const auto name = method.get<std::string>();
    const bool hasCenters = name == "paper" || name == "normalized";
    return fmt::format("BRDF terms: of factorization {}, from values of f {}", name,
                       hasCenters ? "at the maps' texel centers" : "averaged over the maps' texels");
}

OrderedJson describeApproximations(const Asset& asset) {
    const int all = 6 * asset.faceSize * asset.faceSize;
    OrderedJson list = OrderedJson::array();
    list.push_back(
        fmt::format("light: infinitely far away, {}, even over each of 6 x {}² texels",
                    asset.bounces == 0 ? std::string("direct alone")
                    : asset.bounces == 1
                        ? std::string("direct and by one reflection between surfaces")
                        : fmt::format("direct and by up to {} reflections between surfaces", asset.bounces),
                    asset.faceSize));
    list.push_back(describeVisibility(asset));
    list.push_back(describeInterpolation(optionOf(asset, "refinement")));
    list.push_back("transport: " + describeSamples(asset.transportSamples));
    if (asset.coefficients < all)
        list.push_back(fmt::format(
            "truncation: of the {1} coefficients of a vertex and term at most the {0} largest were kept",
            describeRowEntries(asset), all));
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            list.push_back(fmt::format(
                "layout of {}: {}", part.name,
                std::visit([](const auto& layout) { return describeLayout(layout); }, set.transport)));
    if (asset.layout)
        list.push_back(fmt::format(
            "error of the layout against the rows as baked: {:.2f} %, {}", 100 * asset.layout->error,
            asset.layout->wantedBytes
                ? fmt::format("{:g} bytes a vertex being asked for", *asset.layout->wantedBytes)
                : fmt::format("{:g} % being asked for", 100 * asset.layout->wantedError.value_or(0))));
    list.push_back(describeTerms(asset));
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            list.push_back(fmt::format(
                "BRDF of {}: {} terms, maps of {} x {}{}; what they leave of it is added, unshadowed, "
                "when it is drawn",
                part.name, set.brdf.terms, set.brdf.size, set.brdf.size,
                set.brdf.layers > 1 ? ", light maps shared in a set" : ""));
    for (const AssetPart& part : asset.parts)
        if (part.detail.normalMap)
            list.push_back(fmt::format("normal map of {}: {}", part.name,
                                       part.sets[0].residual
                                           ? "unshadowed light is of its normals, the share that reaches the "
                                             "surface of the vertices'"
                                           : "not drawn, since its terms are the whole BRDF"));
    if (asset.provenance.bakedShare)
        list.push_back(fmt::format("preview: {:.0f} % of the vertices are baked, the others interpolated",
                                   100 * *asset.provenance.bakedShare));
    return list;
}

OrderedJson describeLayout(const LayoutRecord& layout) {
    OrderedJson json = OrderedJson::object();
    if (layout.wantedBytes) json["wanted_bytes_per_vertex"] = *layout.wantedBytes;
    if (layout.wantedError) json["wanted_error"] = *layout.wantedError;
    json["error"] = layout.error;
    return json;
}

OrderedJson describeTotal(const Asset& asset) {
    uint64_t vertices = 0, triangles = 0, bytes = 0;
    for (const AssetPart& part : asset.parts) {
        vertices += part.mesh.vertexCount();
        triangles += part.mesh.triangleCount();
        for (const MaterialSet& set : part.sets) bytes += bytesOf(set.transport);
    }
    return {{"vertices", vertices},
            {"triangles", triangles},
            {"bytes_per_vertex", ratio(bytes, vertices)},
            {"transport_bytes", bytes}};
}

} // namespace

std::string describeAssetJson(const Asset& asset, uint64_t fileBytes, uint64_t visibilityBytes) {
    const OrderedJson total = describeTotal(asset);
    OrderedJson parts = OrderedJson::array();
    for (const AssetPart& part : asset.parts) parts.push_back(describePart(part));
    OrderedJson info = {{"format_version", kAssetFormatVersion},
                        {"file_bytes", fileBytes},
                        {"face_size", asset.faceSize},
                        {"visibility_size", asset.visibilitySize},
                        {"coefficients", asset.coefficients},
                        {"transport_samples", asset.transportSamples},
                        {"visibility_offset", asset.visibilityOffset},
                        {"truncation_error", asset.truncationError},
                        {"quantization_error", asset.quantizationError},
                        {"layout_error", asset.layout ? describeLayout(*asset.layout) : OrderedJson()},
                        {"approximations", describeApproximations(asset)},
                        {"occluder_triangles", asset.occluder.triangleCount()},
                        {"total", total},
                        {"kept_visibility",
                         {{"bytes", visibilityBytes},
                          {"bytes_per_vertex", ratio(visibilityBytes, total["vertices"].get<uint64_t>())}}},
                        {"parts", parts},
                        {"provenance",
                         {{"program", asset.provenance.program},
                          {"device", asset.provenance.device},
                          {"options", jsonOrText(asset.provenance.options)},
                          {"inputs", jsonOrText(asset.provenance.inputs)}}}};
    if (const OrderedJson refinement = optionOf(asset, "refinement"); !refinement.is_null())
        info["refinement"] = refinement;
    if (asset.provenance.bakedShare) info["preview"] = {{"baked_share", *asset.provenance.bakedShare}};
    return info.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string describeRowEntries(const Asset& asset) {
    std::set<int> numbers;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) numbers.insert(rowEntries(asset, set));
    return fmt::format("{}", fmt::join(numbers, " or "));
}

} // namespace relume

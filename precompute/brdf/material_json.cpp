#include "precompute/brdf/material_json.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/json_object.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/model_list.h"

#include <fmt/core.h>

namespace relume {

using nlohmann::json;

namespace {

// Materials are a few lines; anything longer or deeper is a mistake.
constexpr size_t kMaxTextSize = 1 << 16;
constexpr int kMaxDepth = 8;

} // namespace

bool canBePath(const std::string& text) {
    return text.size() <= kMaxPathLength && text.find('\0') == std::string::npos;
}

bool looksLikeJson(const std::string& text) {
    const size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

json parseMaterial(const std::string& text) {
    if (text.size() > kMaxTextSize)
        throw UsageError(
            fmt::format("material of {} bytes: expected a name, or a JSON object of at most {} bytes",
                        text.size(), kMaxTextSize));
    if (isJsonDeeper(text, kMaxDepth))
        throw UsageError(fmt::format("material in JSON is nested more than {} levels deep", kMaxDepth));
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        throw UsageError(fmt::format("material is not valid JSON: {}", error.what()));
    }
}

std::optional<MaterialFile> readMaterialFile(const std::string& material,
                                             const std::filesystem::path& folder) {
    if (!canBePath(material) || looksLikeJson(material) || !material.ends_with(".json")) return std::nullopt;
    const std::filesystem::path path = folder / material;
    std::error_code failure;
    if (!std::filesystem::exists(path, failure))
        throw Error(
            fmt::format("{}: material file not found; give the path of a file that holds a material in JSON",
                        path.generic_string()));
    const std::vector<std::byte> bytes = readFile(path, kMaxTextSize);
    return MaterialFile{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.parent_path()};
}

nlohmann::ordered_json describeMaterials() {
    nlohmann::ordered_json presets = nlohmann::ordered_json::array(), models = presets;
    for (const MaterialPreset& preset : materialPresets())
        presets.push_back({{"name", preset.name},
                           {"description", preset.description},
                           {"material", makeBrdf(preset.name)->describe()}});
    for (const MaterialModel& model : materialModels()) {
        nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
        for (const MaterialParameter& parameter : model.parameters)
            parameters.push_back({{"name", parameter.name},
                                  {"values", parameter.values},
                                  {"default", parameter.fallback.empty()
                                                  ? nlohmann::ordered_json(nullptr)
                                                  : nlohmann::ordered_json::parse(parameter.fallback)}});
        models.push_back(
            {{"name", model.name}, {"description", model.description}, {"parameters", parameters}});
    }
    return {{"presets", presets}, {"models", models}};
}

} // namespace relume

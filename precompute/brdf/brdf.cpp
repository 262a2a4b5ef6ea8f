#include "precompute/brdf/brdf.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"
#include "precompute/brdf/model_list.h"
#include "precompute/brdf/presets.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace relume {

using nlohmann::json;

namespace {

// A material is a few lines: anything longer or deeper is a mistake.
constexpr size_t kMaxTextSize = 1 << 16;
constexpr int kMaxDepth = 4;

json parse(const std::string& text) {
    if (text.size() > kMaxTextSize)
        throw UsageError("material of {} bytes: expected a name, or a JSON object of at most {} bytes",
                         text.size(), kMaxTextSize);
    const auto checkDepth = [](int depth, json::parse_event_t, const json&) {
        if (depth > kMaxDepth)
            throw UsageError("material in JSON is nested more than {} levels deep", kMaxDepth);
        return true;
    };
    try {
        return json::parse(text, checkDepth);
    } catch (const json::exception& error) {
        throw UsageError("material is not valid JSON: {}", error.what());
    }
}

std::unique_ptr<Brdf> makeFromJson(const std::string& text) {
    json object = parse(text);
    const auto model = object.is_object() ? object.find("model") : object.end();
    if (model == object.end() || !model->is_string())
        throw UsageError(
            R"(material in JSON must be an object with a model's name: {{"model": "plastic", …}})");
    const std::string name = *model;
    object.erase("model");
    return makeModel(name, object);
}

bool looksLikeJson(const std::string& text) {
    const size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

[[noreturn]] void failUnknownMaterial(const std::string& material) {
    std::vector<std::string_view> names;
    for (const PresetDefinition& preset : presetDefinitions()) names.push_back(preset.name);
    const std::string presets = fmt::format("{}", fmt::join(names, ", "));
    for (const std::string_view model : modelNames())
        if (std::find(names.begin(), names.end(), model) == names.end()) names.push_back(model);
    throw UsageError("unknown material \"{}\"; did you mean \"{}\"? Presets: {}; or a JSON object: "
                     R"({{"model": "plastic", …}})",
                     material.substr(0, 60), nearestName(material, names), presets);
}

} // namespace

std::unique_ptr<Brdf> makeBrdf(const std::string& material) {
    if (looksLikeJson(material)) return makeFromJson(material);
    for (const PresetDefinition& preset : presetDefinitions())
        if (material == preset.name) return makeFromJson(preset.json);
    for (const std::string_view model : modelNames())
        if (material == model) return makeModel(material, json::object());
    failUnknownMaterial(material);
}

std::vector<MaterialPreset> materialPresets() {
    std::vector<MaterialPreset> presets;
    for (const PresetDefinition& preset : presetDefinitions())
        presets.push_back({preset.name, preset.description, json::parse(preset.json)["model"]});
    return presets;
}

} // namespace relume

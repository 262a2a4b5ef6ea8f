#include "precompute/brdf/brdf.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/measured.h"
#include "precompute/brdf/model_list.h"
#include "precompute/brdf/presets.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace relume {

using nlohmann::json;

namespace {

std::unique_ptr<Brdf> makeFromJson(const std::string& text, const std::filesystem::path& folder) {
    json object = parseMaterial(text);
    if (object.is_object() && object.contains("name") && object["name"].is_string()) object.erase("name");
    if (object.is_object() && object.contains("measured")) {
        MaterialParameters parameters("measured", std::move(object));
        return makeMeasured(parameters, folder);
    }
    for (const char* list : {"set", "separate"})
        if (object.is_object() && object.contains(list))
            throw UsageError(fmt::format(
                "material in JSON: \"{}\" stands for several materials, where one is asked for", list));
    const auto model = object.is_object() ? object.find("model") : object.end();
    if (model == object.end() || !model->is_string())
        throw UsageError(fmt::format(
            "material in JSON must be an object with a model's name, {{\"model\": \"plastic\", …}}, "
            "or with measured data, {{\"measured\": \"steel.binary\"}}"));
    const std::string name = *model;
    object.erase("model");
    return makeModel(name, object);
}

// Makes a material given as a path; returns null if it does not look like one.
std::unique_ptr<Brdf> makeFromFile(const std::string& material, const std::filesystem::path& folder) {
    if (const auto file = readMaterialFile(material, folder)) {
        try {
            return makeFromJson(file->text, file->folder);
        } catch (const UsageError& wrong) {
            throw Error(fmt::format("{}: {}", (folder / material).generic_string(), wrong.what()));
        }
    }
    if (!canBePath(material)) return nullptr;
    const std::filesystem::path path = material;
    if (path.extension() != ".binary" && path.extension() != ".brdf") return nullptr;
    MaterialParameters parameters("measured", {{"measured", material}});
    return makeMeasured(parameters, folder);
}

[[noreturn]] void failUnknownMaterial(const std::string& material) {
    std::vector<std::string_view> names;
    for (const PresetDefinition& preset : presetDefinitions()) names.push_back(preset.name);
    const std::string presets = fmt::format("{}", fmt::join(names, ", "));
    for (const std::string_view model : modelNames())
        if (std::find(names.begin(), names.end(), model) == names.end()) names.push_back(model);
    throw UsageError(
        fmt::format("unknown material \"{}\"; did you mean \"{}\"? Presets: {}; or a JSON object: "
                    R"({{"model": "plastic", …}}; or a file ending in .json, .binary or .brdf)",
                    material.substr(0, 60), nearestName(material, names), presets));
}

} // namespace

std::unique_ptr<Brdf> makeBrdf(const std::string& material, const std::filesystem::path& folder) {
    if (looksLikeJson(material)) return makeFromJson(material, folder);
    for (const PresetDefinition& preset : presetDefinitions())
        if (material == preset.name) return makeFromJson(preset.json, folder);
    for (const std::string_view model : modelNames())
        if (material == model) return makeModel(material, json::object());
    if (auto brdf = makeFromFile(material, folder)) return brdf;
    failUnknownMaterial(material);
}

std::vector<MaterialPreset> materialPresets() {
    std::vector<MaterialPreset> presets;
    for (const PresetDefinition& preset : presetDefinitions())
        presets.push_back({preset.name, preset.description, json::parse(preset.json)["model"]});
    return presets;
}

} // namespace relume

#include "precompute/brdf/brdf.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/nearest_name.h"
#include "precompute/brdf/measured.h"
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
constexpr size_t kMaxPathLength = 4096;

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

std::unique_ptr<Brdf> makeFromJson(const std::string& text, const std::filesystem::path& folder) {
    json object = parse(text);
    if (object.is_object() && object.contains("measured")) {
        MaterialParameters parameters("measured", std::move(object));
        return makeMeasured(parameters, folder);
    }
    const auto model = object.is_object() ? object.find("model") : object.end();
    if (model == object.end() || !model->is_string())
        throw UsageError(
            "material in JSON must be an object with a model's name, {{\"model\": \"plastic\", …}}, "
            "or with measured data, {{\"measured\": \"steel.binary\"}}");
    const std::string name = *model;
    object.erase("model");
    return makeModel(name, object);
}

std::unique_ptr<Brdf> makeFromJsonFile(const std::filesystem::path& path) {
    std::error_code failure;
    if (!std::filesystem::exists(path, failure))
        throw Error("{}: material file not found; give the path of a file that holds a material in JSON",
                    path.generic_string());
    const std::vector<std::byte> bytes = readFile(path, kMaxTextSize);
    try {
        return makeFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.parent_path());
    } catch (const UsageError& wrong) {
        throw Error("{}: {}", path.generic_string(), wrong.what());
    }
}

// A material given as a path; none if it does not look like one.
std::unique_ptr<Brdf> makeFromFile(const std::string& material, const std::filesystem::path& folder) {
    if (material.size() > kMaxPathLength || material.find('\0') != std::string::npos) return nullptr;
    const std::filesystem::path path = material;
    if (path.extension() == ".json") return makeFromJsonFile(folder / path);
    if (path.extension() != ".binary" && path.extension() != ".brdf") return nullptr;
    MaterialParameters parameters("measured", {{"measured", material}});
    return makeMeasured(parameters, folder);
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
                     R"({{"model": "plastic", …}}; or a file ending in .json, .binary or .brdf)",
                     material.substr(0, 60), nearestName(material, names), presets);
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

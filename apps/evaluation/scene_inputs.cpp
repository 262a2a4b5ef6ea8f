#include "apps/evaluation/scene_inputs.h"

#include "engine/base/check.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace relume {

namespace {

// Of Debian's packages glmark2-data and blender-data.
constexpr const char* kInstalledBunny = "/usr/share/glmark2/models/bunny.obj";
constexpr const char* kInstalledLights = "/usr/share/blender/datafiles/studiolights/world";

struct Known {
    const char *name, *title, *installed; // installed: stands in for it
    UpAxis up = UpAxis::Y;
};

constexpr std::array kModels = {
    Known{"bunny", "bunny", ""},
    Known{"buddha", "Buddha", "", UpAxis::Z}, // as Stanford's simplified model has it
    Known{"dragon", "dragon", ""},
    Known{"lucy", "Lucy", ""},
};
constexpr std::array kEnvironments = {
    Known{"grace", "Grace Cathedral", "interior"},
    Known{"stpeters", "St Peter's Basilica", "courtyard"},
    Known{"rnl", "Eucalyptus Grove", "forest"},
    Known{"uffizi", "Uffizi Gallery", "city"},
};

template <size_t kCount>
const Known& known(const std::array<Known, kCount>& list, const std::string& name) {
    const auto found = std::ranges::find_if(list, [&](const Known& one) { return name == one.name; });
    RELUME_CHECK(found != list.end());
    return *found;
}

// What readers know.
constexpr std::array<std::string_view, 4> kMeshes = {".obj", ".ply", ".glb", ".gltf"};
constexpr std::array<std::string_view, 2> kMaps = {".exr", ".hdr"};

std::string lowerExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

// "DIR/meshes/lucy*.{obj,ply}": what was looked for.
std::string patternOf(const std::filesystem::path& data, const char* folder, const std::string& name,
                      std::span<const std::string_view> extensions) {
    std::string list;
    for (const std::string_view extension : extensions)
        list += fmt::format("{}{}", list.empty() ? "" : ",", extension.substr(1));
    return fmt::format("{}{}.{{{}}}", data.empty() ? "--data DIR with " : "",
                       (data / folder / (name + "*")).string(), list);
}

std::filesystem::path installedLight(const std::string& name) {
    return std::filesystem::path(kInstalledLights) / (name + ".exr");
}

} // namespace

std::string describe(const SceneInput& input) {
    return input.standsFor.empty() ? input.name
                                   : fmt::format("{}, standing for {}", input.name, input.standsFor);
}

std::filesystem::path SceneInputs::inData(const char* folder, const std::string& name,
                                          std::span<const std::string_view> extensions) const {
    if (mData.empty()) return {};
    std::error_code failure, unknown;
    std::vector<std::filesystem::path> files;
    std::filesystem::directory_iterator entry(mData / folder, failure);
    for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
        const std::filesystem::path& path = entry->path();
        if (path.filename().string().starts_with(name) &&
            std::ranges::find(extensions, lowerExtension(path)) != extensions.end() &&
            std::filesystem::is_regular_file(path, unknown))
            files.push_back(path);
    }
    return files.empty() ? std::filesystem::path() : *std::ranges::min_element(files);
}

std::optional<SceneInput> SceneInputs::find(const std::string& title,
                                            const std::vector<std::filesystem::path>& places) {
    for (const std::filesystem::path& place : places) {
        std::error_code failure;
        if (place.empty() || !std::filesystem::is_regular_file(place, failure)) continue;
        std::string& hash = mHashes[place];
        if (hash.empty()) hash = hashText(readFile(place));
        return SceneInput{title, place, UpAxis::Y, hash, ""};
    }
    return std::nullopt;
}

void SceneInputs::miss(const std::string& title, const std::string& lookedFor, const std::string& instead) {
    const std::string line = fmt::format("{}: looked for {}; {}", title, lookedFor, instead);
    if (std::ranges::find(mMissing, line) == mMissing.end()) mMissing.push_back(line);
}

std::optional<SceneInput> SceneInputs::model(const std::string& name) {
    const Known& wanted = known(kModels, name);
    const auto own = inData("meshes", name, kMeshes);
    const bool isBunny = name == "bunny";
    if (auto found = find(wanted.title, {own, isBunny ? kInstalledBunny : ""})) {
        // What is installed has Y up, as has the usual file of every other model.
        found->up = found->file == own ? wanted.up : UpAxis::Y;
        return found;
    }
    const std::string lookedFor = patternOf(mData, "meshes", name, kMeshes);
    std::optional<SceneInput> standIn;
    if (mStandIns && !isBunny) standIn = find("bunny", {inData("meshes", "bunny", kMeshes), kInstalledBunny});
    if (standIn) standIn->standsFor = wanted.title;
    miss(wanted.title, isBunny ? lookedFor + " and " + kInstalledBunny : lookedFor,
         standIn ? "the bunny stands for it" : "scenes that need it are skipped");
    return standIn;
}

std::optional<SceneInput> SceneInputs::environment(const std::string& name) {
    const Known& wanted = known(kEnvironments, name);
    if (auto found = find(wanted.title, {inData("environments", name, kMaps)})) return found;
    std::optional<SceneInput> standIn;
    if (mStandIns)
        standIn = find(fmt::format("Blender's {}", wanted.installed), {installedLight(wanted.installed)});
    if (standIn) standIn->standsFor = wanted.title;
    miss(wanted.title, patternOf(mData, "environments", name, kMaps),
         standIn ? standIn->name + " stands for it" : "scenes that need it are skipped");
    return standIn;
}

std::optional<SceneInput> SceneInputs::anyEnvironment() {
    if (auto found = find("Blender's interior", {installedLight("interior")})) return found;
    miss("An environment", installedLight("interior").string(), "scenes that need it are skipped");
    return std::nullopt;
}

} // namespace relume

#include "precompute/brdf/material_list.h"

#include "engine/base/error.h"
#include "precompute/brdf/material_json.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

using nlohmann::json;

namespace {

// A material's JSON, or its name as a JSON string, and the folder that its paths are relative to.
struct Source {
    json value;
    std::filesystem::path folder;
    std::string file; // file it was read from, for names and errors; empty if none
};

// Resolves the name of a .json file to its content, which is an object and so cannot name another file in its
// place.
Source resolve(const json& value, const std::filesystem::path& folder) {
    if (!value.is_string()) return {value, folder, ""};
    const std::string text = value;
    const auto file = readMaterialFile(text, folder);
    if (!file) return {value, folder, ""};
    const std::string path = (folder / text).generic_string();
    try {
        json content = parseMaterial(file->text);
        if (!content.is_object())
            throw UsageError(fmt::format("expected an object, found {}", content.type_name()));
        return {std::move(content), file->folder, path};
    } catch (const UsageError& wrong) {
        throw Error(fmt::format("{}: {}", path, wrong.what()));
    }
}

// Checks a name, which will be printed and written on command lines.
void checkName(const std::string& name) {
    const auto isControl = [](char letter) { return uint8_t(letter) < 0x20 || letter == 0x7f; };
    if (name.empty() || std::ranges::any_of(name, isControl))
        throw UsageError(
            "materials in JSON: \"name\": expected text that is not empty, without control characters");
}

class ListReader {
  public:
    MaterialSets read(const std::string& text, const std::filesystem::path& folder) {
        const Source source = resolve(looksLikeJson(text) ? parseMaterial(text) : json(text), folder);
        if (const json* list = listOf(source.value, "separate")) {
            for (const json& element : *list) readSet(resolve(element, source.folder));
        } else {
            readSet(source);
        }
        return std::move(mSets);
    }

  private:
    // Returns the list under `key` if the object has this key, which must then be its only one; else null.
    static const json* listOf(const json& value, const char* key) {
        if (!value.is_object() || !value.contains(key)) return nullptr;
        const json& list = value[key];
        if (value.size() != 1)
            throw UsageError(
                fmt::format("materials in JSON: expected {{\"{}\": [MATERIAL, …]}} and nothing else", key));
        if (!list.is_array() || list.empty())
            throw UsageError(
                fmt::format("materials in JSON: \"{}\": expected a list of one material or more, found {}",
                            key, list.is_array() ? "an empty one" : list.type_name()));
        return &list;
    }

    void readSet(const Source& source) {
        mSets.emplace_back();
        const json* list = listOf(source.value, "set");
        if (!list) return add(source);
        for (const json& element : *list) add(resolve(element, source.folder));
        if (mSets.back().size() > kMostSetMaterials)
            throw UsageError(
                fmt::format("{} materials in a set, which can hold {}: make several sets of them, "
                            "{{\"separate\": [{{\"set\": […]}}, …]}}",
                            mSets.back().size(), kMostSetMaterials));
    }

    void add(const Source& source) {
        const json& value = source.value;
        if (mNames.size() == kMostMaterials)
            throw UsageError(fmt::format("more than {} materials for a part", kMostMaterials));
        if (!value.is_string() && !value.is_object())
            throw UsageError(
                fmt::format("materials in JSON: expected a name or an object, found {}", value.type_name()));
        std::string name;
        if (value.is_object() && value.contains("name")) {
            if (value["name"].is_string()) name = value["name"];
            checkName(name);
            if (std::ranges::find(mNames, name) != mNames.end())
                throw UsageError(
                    fmt::format("two materials are called \"{}\": give one another \"name\"", name));
        } else {
            name = unusedName(source.file.empty() ? defaultName(value)
                                                  : std::filesystem::path(source.file).stem().string());
            checkName(name);
        }
        mNames.push_back(name);
        try {
            mSets.back().push_back(
                {name, makeBrdf(value.is_string() ? value.get<std::string>() : value.dump(), source.folder)});
        } catch (const UsageError& wrong) {
            if (source.file.empty()) throw;
            throw Error(fmt::format("{}: {}", source.file, wrong.what()));
        }
    }

    static std::string defaultName(const json& value) {
        const auto isText = [&](const char* key) {
            return value.is_object() && value.contains(key) && value[key].is_string();
        };
        if (isText("model")) return value["model"];
        const std::string text = isText("measured")  ? value["measured"].get<std::string>()
                                 : value.is_string() ? value.get<std::string>()
                                                     : "material";
        const std::filesystem::path path = text;
        return path.has_extension() ? path.stem().string() : text;
    }

    std::string unusedName(const std::string& name) const {
        std::string unused = name;
        for (int number = 2; std::ranges::find(mNames, unused) != mNames.end(); number++)
            unused = fmt::format("{} {}", name, number);
        return unused;
    }

    MaterialSets mSets;
    std::vector<std::string> mNames;
};

} // namespace

MaterialSets readMaterials(const std::string& text, const std::filesystem::path& folder) {
    return ListReader().read(text, folder);
}

} // namespace relume

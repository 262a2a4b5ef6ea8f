#include "precompute/brdf/material_list.h"

#include "engine/base/error.h"
#include "precompute/brdf/material_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace relume {

using nlohmann::json;

namespace {

class ListReader {
  public:
    MaterialSets read(const std::string& text, const std::filesystem::path& folder) {
        if (const auto file = readMaterialFile(text, folder)) {
            try {
                return read(file->text, file->folder);
            } catch (const UsageError& wrong) {
                throw Error("{}: {}", (folder / text).generic_string(), wrong.what());
            }
        }
        const json value = looksLikeJson(text) ? parseMaterial(text) : json(text);
        if (const json* list = listOf(value, "separate")) {
            for (const json& element : *list) readSet(element, folder);
        } else {
            readSet(value, folder);
        }
        return std::move(mSets);
    }

  private:
    // The value of an object's only key, if it is this one.
    static const json* listOf(const json& value, const char* key) {
        if (!value.is_object() || !value.contains(key)) return nullptr;
        const json& list = value[key];
        if (value.size() != 1 || !list.is_array() || list.empty())
            throw UsageError("materials in JSON: expected {{\"{}\": [MATERIAL, …]}} and nothing else", key);
        return &list;
    }

    void readSet(const json& value, const std::filesystem::path& folder) {
        mSets.emplace_back();
        const json* list = listOf(value, "set");
        if (!list) return add(value, folder);
        for (const json& element : *list) add(element, folder);
    }

    void add(json value, const std::filesystem::path& folder) {
        if (mNames.size() == kMostMaterials)
            throw UsageError("more than {} materials for a part", kMostMaterials);
        std::string name;
        if (value.is_object() && value.contains("name")) {
            if (!value["name"].is_string() || value["name"].get<std::string>().empty())
                throw UsageError("materials in JSON: \"name\": expected text");
            name = value["name"];
            if (std::ranges::find(mNames, name) != mNames.end())
                throw UsageError("two materials are called \"{}\"", name);
            value.erase("name");
        } else {
            name = unusedName(defaultName(value));
        }
        if (!value.is_string() && !value.is_object())
            throw UsageError("materials in JSON: expected a name or an object, found {}", value.type_name());
        mNames.push_back(name);
        mSets.back().push_back(
            {name, makeBrdf(value.is_string() ? value.get<std::string>() : value.dump(), folder)});
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

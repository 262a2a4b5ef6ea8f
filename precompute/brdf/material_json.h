// Materials as JSON: their text, and the files that hold it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace relume {

bool looksLikeJson(const std::string& text);

// Throws UsageError for what is no JSON, too long or nested too deep for a material.
nlohmann::json parseMaterial(const std::string& text);

// The text of a material given as the path of a .json file, and the folder that paths in it start at; none if
// it is not given so. Throws Error for a file that cannot be read.
struct MaterialFile {
    std::string text;
    std::filesystem::path folder;
};
std::optional<MaterialFile> readMaterialFile(const std::string& material,
                                             const std::filesystem::path& folder);

// All presets and models with their parameters: what `relume materials --json` prints.
nlohmann::ordered_json describeMaterials();

} // namespace relume

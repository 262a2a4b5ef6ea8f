// Materials as JSON: as text, and in files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace relume {

constexpr size_t kMaxPathLength = 4096; // in bytes; Linux's PATH_MAX

// Returns whether text is short enough for a path, and without NUL.
bool canBePath(const std::string& text);

bool looksLikeJson(const std::string& text);

// Throws UsageError if the text is not JSON, or is too long or too deeply nested for a material.
nlohmann::json parseMaterial(const std::string& text);

// The text of a material file, and the folder at which relative paths in it start. readMaterialFile() returns
// nothing if `material` is not the path of a .json file, and throws Error if the file cannot be read.
struct MaterialFile {
    std::string text;
    std::filesystem::path folder;
};
std::optional<MaterialFile> readMaterialFile(const std::string& material,
                                             const std::filesystem::path& folder);

// Returns all presets and models with their parameters, as printed by `relume materials --json`.
nlohmann::ordered_json describeMaterials();

} // namespace relume

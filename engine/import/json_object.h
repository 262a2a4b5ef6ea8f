// Checked access to JSON files that people write. Unknown keys and wrong values are errors that name file,
// place and key.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace relume {

// Read a JSON file of at most 16 MiB, parsed or as text. Throw Error.
nlohmann::json readJson(const std::filesystem::path& path);
std::string readJsonText(const std::filesystem::path& path);

// The most nested arrays and objects in what a bake records of itself: options, inputs, materials.
constexpr size_t kRecordDepth = 8;

// Returns whether arrays and objects are nested more than `most` deep. The library's parser could tell by a
// callback, but would then take time quadratic in an array's length.
bool isJsonDeeper(std::string_view text, size_t most);

// Parses JSON; `name` names the text in errors. Throws Error if it is invalid or nested too deeply.
nlohmann::json parseJson(std::string_view text, const std::string& name, size_t mostDepth = 32);

// A JSON object whose values are read by key. Throws Error for values of a wrong type or out of range.
class JsonObject {
  public:
    using Json = nlohmann::json;

    // `place` names the file, and the object in it, in errors. Throws Error unless `json`, which must outlive
    // this, is an object without other keys than these.
    JsonObject(const Json& json, std::string place, std::span<const std::string_view> keys);

    // Returns null if the key is missing.
    const Json* find(const char* key) const;
    // Throws Error: names place and key, what was expected, and what was found.
    [[noreturn]] void fail(const char* key, std::string_view expected) const;

    std::string text(const char* key, const std::string& fallback) const; // never empty if the key is there
    float number(const char* key, float fallback, float low, float high) const;
    bool flag(const char* key, bool fallback) const;
    vec3 vector(const char* key, vec3 fallback, float low, float high) const;

    // Read keys that must be there.
    std::string requiredText(const char* key, std::string_view expected) const;
    float requiredNumber(const char* key, float low, float high) const;
    vec3 requiredVector(const char* key, float low, float high) const;

    const std::string& place() const { return mPlace; }

  private:
    float check(const char* key, const Json& value, float low, float high) const;

    const Json& mJson;
    std::string mPlace;
};

} // namespace relume

// Objects of JSON files that people write, checked: unknown keys and wrong values are errors that name file,
// place and field.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace relume {

// A JSON file of at most 16 MiB, and its text. Throw Error.
nlohmann::json readJson(const std::filesystem::path& path);
std::string readJsonText(const std::filesystem::path& path);

// Returns whether arrays and objects are nested more than `most` deep. The library's parser could tell by a
// callback, but with one its time grows with the square of an array's length.
bool isJsonDeeper(std::string_view text, size_t most);

// `name` stands for the text in errors. Throws Error.
nlohmann::json parseJson(std::string_view text, const std::string& name, size_t mostDepth = 32);

class JsonObject {
  public:
    using Json = nlohmann::json;

    // `place`: the file, and where in it. Throws Error unless `json`, which must outlive this, is an object
    // with none but these keys.
    JsonObject(const Json& json, std::string place, std::span<const std::string_view> keys);

    // Null when the key is not there.
    const Json* find(const char* key) const;
    [[noreturn]] void fail(const char* key, std::string_view expected) const;

    std::string text(const char* key, const std::string& fallback) const; // never empty if the key is there
    float number(const char* key, float fallback, float low, float high) const;
    bool flag(const char* key, bool fallback) const;
    vec3 vector(const char* key, vec3 fallback, float low, float high) const;

    // The same of keys that must be there.
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

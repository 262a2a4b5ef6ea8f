// The parameters of a BRDF model as a JSON object, read with their types and ranges checked.
#pragma once

#include "engine/math/vector.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relume {

struct ParameterRange {
    float low, high; // both valid
};

// A parameter as a model has asked for it.
struct MaterialParameter {
    std::string name;
    std::string values;   // "number from 0 to 1"
    std::string fallback; // as JSON; empty where the parameter must be given
};

// Every reader throws UsageError that names the parameter, its valid range and what was found.
class MaterialParameters {
  public:
    // `owner` names the object in messages ("plastic"). Throws unless `object` is a JSON object.
    MaterialParameters(std::string owner, nlohmann::json object);

    bool has(const std::string& key) const { return mObject.contains(key); }

    // A number, or `fallback` where the key is absent.
    float number(const std::string& key, float fallback, ParameterRange range);
    // A number for all three channels, or an array of three, linear sRGB.
    vec3 color(const std::string& key, vec3 fallback, ParameterRange range);
    // The same without a default.
    vec3 requiredColor(const std::string& key, ParameterRange range);
    // A text that must be there, or `fallback` where the key is absent.
    std::string requiredText(const std::string& key);
    std::string text(const std::string& key, const std::string& fallback);
    // A required array of at most `limit` objects.
    std::vector<MaterialParameters> list(const std::string& key, size_t limit);

    // Throws when the object has a key that nobody has asked for, naming the nearest that somebody has.
    void rejectUnknownKeys() const;

    // Every parameter asked for so far: the one place that knows a model's parameters is the code that reads
    // them.
    const std::vector<MaterialParameter>& asked() const { return mAsked; }

  private:
    const nlohmann::json* find(const std::string& key, std::string values, std::string fallback);

    std::string mOwner;
    nlohmann::json mObject;
    std::vector<MaterialParameter> mAsked;
};

// The JSON number of fewest digits that reads back as the same float (0.1, not 0.10000000149011612).
nlohmann::json numberToJson(float value);
// An array of three.
nlohmann::json colorToJson(vec3 color);

} // namespace relume

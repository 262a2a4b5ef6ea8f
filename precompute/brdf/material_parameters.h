// Reads the parameters of a BRDF model from a JSON object, checks types and ranges, and tells all faults at
// once.
#pragma once

#include "engine/math/vector.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relume {

struct ParameterRange {
    float low, high; // both valid
};

// A parameter that a model has read.
struct MaterialParameter {
    std::string name;
    std::string values;   // "number from 0 to 1"
    std::string fallback; // as JSON; empty if the parameter is required
};

// Readers note what is wrong with the parameter, its valid range and what was found, and return a valid value
// in its place; a model's maker reads everything before rejectFaults() throws.
class MaterialParameters {
  public:
    // `owner` names the object in messages ("plastic"). Throws if `object` is not a JSON object.
    MaterialParameters(std::string owner, nlohmann::json object);

    bool has(const std::string& key) const { return mObject.contains(key); }

    // Returns a number, or `fallback` if the key is absent.
    float number(const std::string& key, float fallback, ParameterRange range);
    // Returns a color, linear sRGB, given as an array of three or as one number for all channels.
    vec3 color(const std::string& key, vec3 fallback, ParameterRange range);
    // Returns the same for a key that must be present.
    vec3 requiredColor(const std::string& key, ParameterRange range);
    // Returns a text that must be present and not empty; text() returns `fallback` if it is absent.
    std::string requiredText(const std::string& key);
    std::string text(const std::string& key, const std::string& fallback);
    // Returns an array of at most `limit` objects, which must be present; their faults are noted here.
    std::vector<MaterialParameters> list(const std::string& key, size_t limit);

    // Notes what is wrong with several parameters together.
    void noteFault(const std::string& fault);
    // Notes each key of the object that was not read, with the nearest one that was.
    void noteUnknownKeys();
    // Throws UsageError with all that was noted, unknown keys first: they may be why others are missing.
    void rejectFaults() const;

    // Returns every parameter read so far. This documents a model: its parameters are known only to the code
    // that reads them.
    const std::vector<MaterialParameter>& asked() const { return mAsked; }

  private:
    struct Faults {
        std::vector<std::string> unknownKeys, others;
    };

    const nlohmann::json* find(const std::string& key, std::string values, std::string fallback);
    std::string place() const; // what precedes a fault: "lobes[2]: " in a list's item, else nothing
    vec3 readColor(const std::string& key, const nlohmann::json& value, vec3 fallback, ParameterRange range);

    std::string mOwner, mItem; // mItem: "lobes[2]" of a list's item, else empty
    std::shared_ptr<Faults> mFaults = std::make_shared<Faults>(); // shared with the items of lists
    nlohmann::json mObject;
    std::vector<MaterialParameter> mAsked;
};

// Returns the number with the fewest digits that reads back as the same float (0.1, not 0.10000000149011612).
nlohmann::json numberToJson(float value);
// Returns an array of three numbers.
nlohmann::json colorToJson(vec3 color);

} // namespace relume

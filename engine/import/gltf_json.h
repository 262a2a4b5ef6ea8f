// Members of a glTF document's objects, of which nothing has been checked. `place` names the object in
// errors; keys that nobody asks for are left alone, as the specification wants it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relume {

// The member of this name, or null. Throws Error, as all of these, unless `object` is one.
const nlohmann::json* findGltfMember(const nlohmann::json& object, const char* key, const std::string& place);

// The same, where an object without members does for none.
const nlohmann::json& gltfObject(const nlohmann::json& object, const char* key, const std::string& place);

// A finite number.
double gltfNumber(const nlohmann::json& object, const char* key, double fallback, const std::string& place);

// As many finite numbers as `fallback` has.
std::vector<double> gltfNumbers(const nlohmann::json& object, const char* key, std::vector<double> fallback,
                                const std::string& place);

// The number of an element.
std::optional<size_t> gltfIndex(const nlohmann::json& object, const char* key, const std::string& place);

// Empty where there is none.
std::string gltfText(const nlohmann::json& object, const char* key, const std::string& place);

} // namespace relume

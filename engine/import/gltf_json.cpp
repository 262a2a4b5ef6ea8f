#include "engine/import/gltf_json.h"

#include "engine/base/error.h"

#include <cmath>
#include <cstdint>
#include <fmt/core.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace relume {

using Json = nlohmann::json;

namespace {

double toNumber(const Json& json, const char* key, const std::string& place) {
    const double number = json.is_number() ? json.get<double>() : NAN;
    if (!std::isfinite(number))
        throw Error(
            fmt::format("{}: \"{}\": expected finite numbers, found {}", place, key, json.type_name()));
    return number;
}

} // namespace

const Json* findGltfMember(const Json& object, const char* key, const std::string& place) {
    if (!object.is_object())
        throw Error(fmt::format("{}: expected an object, found {}", place, object.type_name()));
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const Json& gltfObject(const Json& object, const char* key, const std::string& place) {
    static const Json kNone = Json::object();
    const Json* found = findGltfMember(object, key, place);
    if (found && !found->is_object())
        throw Error(fmt::format("{}: \"{}\": expected an object, found {}", place, key, found->type_name()));
    return found ? *found : kNone;
}

double gltfNumber(const Json& object, const char* key, double fallback, const std::string& place) {
    const Json* found = findGltfMember(object, key, place);
    return found ? toNumber(*found, key, place) : fallback;
}

std::vector<double> gltfNumbers(const Json& object, const char* key, std::vector<double> fallback,
                                const std::string& place) {
    const Json* found = findGltfMember(object, key, place);
    if (!found) return fallback;
    if (!found->is_array() || found->size() != fallback.size())
        throw Error(fmt::format("{}: \"{}\": expected {} numbers", place, key, fallback.size()));
    std::vector<double> values;
    for (const Json& value : *found) values.push_back(toNumber(value, key, place));
    return values;
}

std::optional<size_t> gltfIndex(const Json& object, const char* key, const std::string& place) {
    const Json* found = findGltfMember(object, key, place);
    if (!found) return std::nullopt;
    if (!found->is_number_unsigned() || found->get<uint64_t>() > uint64_t(std::numeric_limits<int>::max()))
        throw Error(fmt::format("{}: \"{}\": expected the number of an element", place, key));
    return found->get<size_t>();
}

std::string gltfText(const Json& object, const char* key, const std::string& place) {
    const Json* found = findGltfMember(object, key, place);
    if (found && !found->is_string())
        throw Error(fmt::format("{}: \"{}\": expected a text, found {}", place, key, found->type_name()));
    return found ? found->get<std::string>() : "";
}

} // namespace relume

#include "engine/import/json_object.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace relume {

constexpr size_t kLargestFile = size_t(16) << 20;

bool isJsonDeeper(std::string_view text, size_t most) {
    size_t depth = 0;
    bool isInText = false;
    for (size_t i = 0; i < text.size() && depth <= most; i++) {
        const char c = text[i];
        if (c == '"') isInText = !isInText;
        if (isInText && c == '\\') i++;
        if (isInText) continue;
        if (c == '[' || c == '{') depth++;
        if ((c == ']' || c == '}') && depth > 0) depth--;
    }
    return depth > most;
}

nlohmann::json parseJson(std::string_view text, const std::string& name, size_t mostDepth) {
    if (isJsonDeeper(text, mostDepth))
        throw Error(fmt::format("{}: is nested deeper than any such file", name));
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& failure) {
        throw Error(fmt::format("{}: is not valid JSON: {}", name, failure.what()));
    }
}

std::string readJsonText(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readFile(path, kLargestFile);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

nlohmann::json readJson(const std::filesystem::path& path) {
    return parseJson(readJsonText(path), path.string());
}

JsonObject::JsonObject(const Json& json, std::string place, std::span<const std::string_view> keys)
    : mJson(json), mPlace(std::move(place)) {
    if (!json.is_object())
        throw Error(fmt::format("{}: expected an object {{…}}, found {}", mPlace, json.type_name()));
    for (const auto& [key, value] : json.items())
        if (std::find(keys.begin(), keys.end(), key) == keys.end())
            throw Error(fmt::format("{}: unknown key \"{}\": did you mean \"{}\"? Valid keys are {}", mPlace,
                                    key.substr(0, 40), nearestName(key, keys), fmt::join(keys, ", ")));
}

const nlohmann::json* JsonObject::find(const char* key) const {
    const auto found = mJson.find(key);
    return found == mJson.end() ? nullptr : &*found;
}

void JsonObject::fail(const char* key, std::string_view expected) const {
    const Json* value = find(key);
    std::string found = value ? value->dump(-1, ' ', false, Json::error_handler_t::replace) : "nothing";
    if (found.size() > 60) found = found.substr(0, 60) + "…";
    throw Error(fmt::format("{}: \"{}\": expected {}, found {}", mPlace, key, expected, found));
}

std::string JsonObject::text(const char* key, const std::string& fallback) const {
    return find(key) ? requiredText(key, "a text") : fallback;
}

float JsonObject::number(const char* key, float fallback, float low, float high) const {
    return find(key) ? requiredNumber(key, low, high) : fallback;
}

bool JsonObject::flag(const char* key, bool fallback) const {
    const Json* value = find(key);
    if (value && !value->is_boolean()) fail(key, "true or false");
    return value ? value->get<bool>() : fallback;
}

vec3 JsonObject::vector(const char* key, vec3 fallback, float low, float high) const {
    return find(key) ? requiredVector(key, low, high) : fallback;
}

std::string JsonObject::requiredText(const char* key, std::string_view expected) const {
    const Json* value = find(key);
    if (!value || !value->is_string() || value->get_ref<const std::string&>().empty()) fail(key, expected);
    return value->get<std::string>();
}

float JsonObject::requiredNumber(const char* key, float low, float high) const {
    const Json* value = find(key);
    return check(key, value ? *value : Json(), low, high);
}

vec3 JsonObject::requiredVector(const char* key, float low, float high) const {
    const Json* value = find(key);
    if (!value || !value->is_array() || value->size() != 3) fail(key, "three numbers [x, y, z]");
    return {check(key, (*value)[0], low, high), check(key, (*value)[1], low, high),
            check(key, (*value)[2], low, high)};
}

float JsonObject::check(const char* key, const Json& value, float low, float high) const {
    const float number = value.is_number() ? value.get<float>() : NAN;
    if (!(number >= low && number <= high)) fail(key, fmt::format("numbers from {:g} to {:g}", low, high));
    return number;
}

} // namespace relume

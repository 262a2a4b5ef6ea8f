#include "precompute/brdf/material_parameters.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace relume {

using nlohmann::json;

namespace {

// Returns the value as text, shortened for a message.
std::string excerpt(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    return text;
}

bool isNumberInRange(const json& value, ParameterRange range) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    return number >= double(range.low) && number <= double(range.high);
}

std::string colorValues(ParameterRange range) {
    return fmt::format("number from {} to {}, or [red, green, blue] of such", range.low, range.high);
}

vec3 readColor(const std::string& owner, const std::string& key, const json& value, ParameterRange range) {
    if (isNumberInRange(value, range)) return vec3(value.get<float>());
    const auto inRange = [&](const json& item) { return isNumberInRange(item, range); };
    if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), inRange))
        throw UsageError(fmt::format("material {}: \"{}\" must be a {}, but is {}", owner, key,
                                     colorValues(range), excerpt(value)));
    return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

} // namespace

MaterialParameters::MaterialParameters(std::string owner, json object)
    : mOwner(std::move(owner)), mObject(std::move(object)) {
    if (!mObject.is_object())
        throw UsageError(fmt::format("material {}: expected a JSON object of parameters, found {}", mOwner,
                                     excerpt(mObject)));
}

const json* MaterialParameters::find(const std::string& key, std::string values, std::string fallback) {
    mAsked.push_back({key, std::move(values), std::move(fallback)});
    const auto found = mObject.find(key);
    return found == mObject.end() ? nullptr : &*found;
}

float MaterialParameters::number(const std::string& key, float fallback, ParameterRange range) {
    const std::string values = fmt::format("number from {} to {}", range.low, range.high);
    const json* value = find(key, values, fmt::format("{}", fallback));
    if (!value) return fallback;
    if (!isNumberInRange(*value, range))
        throw UsageError(
            fmt::format("material {}: \"{}\" must be a {}, but is {}", mOwner, key, values, excerpt(*value)));
    return value->get<float>();
}

vec3 MaterialParameters::color(const std::string& key, vec3 fallback, ParameterRange range) {
    const bool isGray = fallback.x == fallback.y && fallback.y == fallback.z;
    const json* value =
        find(key, colorValues(range), (isGray ? numberToJson(fallback.x) : colorToJson(fallback)).dump());
    return value ? readColor(mOwner, key, *value, range) : fallback;
}

vec3 MaterialParameters::requiredColor(const std::string& key, ParameterRange range) {
    const json* value = find(key, colorValues(range), "");
    if (!value)
        throw UsageError(
            fmt::format("material {}: \"{}\" is missing; give a number from {} to {}, or [red, green, blue]",
                        mOwner, key, range.low, range.high));
    return readColor(mOwner, key, *value, range);
}

std::string MaterialParameters::requiredText(const std::string& key) {
    const json* value = find(key, "text", "");
    if (!value || !value->is_string())
        throw UsageError(fmt::format("material {}: \"{}\" must be a text, but {}", mOwner, key,
                                     value ? "is " + excerpt(*value) : std::string("is missing")));
    return *value;
}

std::string MaterialParameters::text(const std::string& key, const std::string& fallback) {
    if (has(key)) return requiredText(key);
    find(key, "text", json(fallback).dump());
    return fallback;
}

std::vector<MaterialParameters> MaterialParameters::list(const std::string& key, size_t limit) {
    const std::string values = fmt::format("array of at most {} objects", limit);
    const json* value = find(key, values, "");
    if (!value || !value->is_array() || value->size() > limit)
        throw UsageError(fmt::format("material {}: \"{}\" must be an {}, but {}", mOwner, key, values,
                                     value ? "is " + excerpt(*value) : std::string("is missing")));
    std::vector<MaterialParameters> items;
    for (size_t i = 0; i < value->size(); i++)
        items.emplace_back(fmt::format("{}, {}[{}]", mOwner, key, i), (*value)[i]);
    return items;
}

void MaterialParameters::rejectUnknownKeys() const {
    std::vector<std::string_view> known;
    for (const MaterialParameter& parameter : mAsked) known.push_back(parameter.name);
    for (const auto& [key, value] : mObject.items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw UsageError(fmt::format("material {}: unknown parameter \"{}\"; did you mean \"{}\"?",
                                         mOwner, key.substr(0, 60), nearestName(key, known)));
}

json numberToJson(float value) { return json::parse(fmt::format("{}", value)); }

json colorToJson(vec3 color) {
    return json::array({numberToJson(color.x), numberToJson(color.y), numberToJson(color.z)});
}

} // namespace relume

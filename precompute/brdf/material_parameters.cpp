#include "precompute/brdf/material_parameters.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <fmt/ranges.h>
#include <utility>

namespace relume {

using nlohmann::json;

namespace {

constexpr size_t kMostToldFaults = 20;

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

std::string MaterialParameters::place() const { return mItem.empty() ? "" : mItem + ": "; }

void MaterialParameters::noteFault(const std::string& fault) { mFaults->others.push_back(place() + fault); }

float MaterialParameters::number(const std::string& key, float fallback, ParameterRange range) {
    const std::string values = fmt::format("number from {} to {}", range.low, range.high);
    const json* value = find(key, values, fmt::format("{}", fallback));
    if (!value) return fallback;
    if (isNumberInRange(*value, range)) return value->get<float>();
    noteFault(fmt::format("\"{}\" must be a {}, but is {}", key, values, excerpt(*value)));
    return fallback;
}

vec3 MaterialParameters::readColor(const std::string& key, const json& value, vec3 fallback,
                                   ParameterRange range) {
    if (isNumberInRange(value, range)) return vec3(value.get<float>());
    const auto inRange = [&](const json& item) { return isNumberInRange(item, range); };
    if (value.is_array() && value.size() == 3 && std::all_of(value.begin(), value.end(), inRange))
        return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
    noteFault(fmt::format("\"{}\" must be a {}, but is {}", key, colorValues(range), excerpt(value)));
    return fallback;
}

vec3 MaterialParameters::color(const std::string& key, vec3 fallback, ParameterRange range) {
    const bool isGray = fallback.x == fallback.y && fallback.y == fallback.z;
    const json* value =
        find(key, colorValues(range), (isGray ? numberToJson(fallback.x) : colorToJson(fallback)).dump());
    return value ? readColor(key, *value, fallback, range) : fallback;
}

vec3 MaterialParameters::requiredColor(const std::string& key, ParameterRange range) {
    const vec3 valid(range.low);
    if (const json* value = find(key, colorValues(range), "")) return readColor(key, *value, valid, range);
    noteFault(fmt::format("\"{}\" is missing; give a number from {} to {}, or [red, green, blue]", key,
                          range.low, range.high));
    return valid;
}

std::string MaterialParameters::requiredText(const std::string& key) {
    const json* value = find(key, "text", "");
    if (value && value->is_string() && *value != "") return *value;
    noteFault(fmt::format("\"{}\" must be a text that is not empty, but {}", key,
                          value ? "is " + excerpt(*value) : std::string("is missing")));
    return "";
}

std::string MaterialParameters::text(const std::string& key, const std::string& fallback) {
    if (has(key)) return requiredText(key);
    find(key, "text", json(fallback).dump());
    return fallback;
}

std::vector<MaterialParameters> MaterialParameters::list(const std::string& key, size_t limit) {
    const std::string values = fmt::format("array of at most {} objects", limit);
    const json* value = find(key, values, "");
    if (!value || !value->is_array() || value->size() > limit) {
        noteFault(fmt::format("\"{}\" must be an {}, but {}", key, values,
                              value ? "is " + excerpt(*value) : std::string("is missing")));
        return {};
    }
    std::vector<MaterialParameters> items;
    for (size_t i = 0; i < value->size(); i++) {
        const std::string item = fmt::format("{}[{}]", key, i);
        if (!(*value)[i].is_object()) {
            noteFault(
                fmt::format("{} must be a JSON object of parameters, but is {}", item, excerpt((*value)[i])));
            continue;
        }
        items.emplace_back(mOwner, (*value)[i]);
        items.back().mItem = item;
        items.back().mFaults = mFaults;
    }
    return items;
}

void MaterialParameters::noteUnknownKeys() {
    std::vector<std::string_view> known;
    for (const MaterialParameter& parameter : mAsked) known.push_back(parameter.name);
    for (const auto& [key, value] : mObject.items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            mFaults->unknownKeys.push_back(fmt::format("{}unknown parameter \"{}\"; did you mean \"{}\"?",
                                                       place(), key.substr(0, 60), nearestName(key, known)));
}

void MaterialParameters::rejectFaults() const {
    std::vector<std::string> faults = mFaults->unknownKeys;
    faults.insert(faults.end(), mFaults->others.begin(), mFaults->others.end());
    if (faults.empty()) return;
    if (faults.size() == 1) throw UsageError(fmt::format("material {}: {}", mOwner, faults[0]));
    const size_t told = std::min(faults.size(), kMostToldFaults);
    const std::string more =
        told < faults.size() ? fmt::format("\n  and {} more", faults.size() - told) : std::string();
    throw UsageError(fmt::format("material {} has {} faults:\n  {}{}", mOwner, faults.size(),
                                 fmt::join(faults.begin(), faults.begin() + ptrdiff_t(told), "\n  "), more));
}

json numberToJson(float value) { return json::parse(fmt::format("{}", value)); }

json colorToJson(vec3 color) {
    return json::array({numberToJson(color.x), numberToJson(color.y), numberToJson(color.z)});
}

} // namespace relume

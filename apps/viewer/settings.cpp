#include "apps/viewer/settings.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"
#include "engine/light/light_vector.h"

#include <algorithm>
#include <fmt/ranges.h>
#include <functional>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using nlohmann::json;

float numberOf(const std::string& name, const json& value, float low, float high) {
    if (!value.is_number() || !(value.get<float>() >= low && value.get<float>() <= high))
        throw Error(
            fmt::format("\"{}\": expected a number from {} to {}, found {}", name, low, high, value.dump()));
    return value.get<float>();
}

vec3 colorOf(const std::string& name, const json& value, float high) {
    if (!value.is_array() || value.size() != 3)
        throw Error(fmt::format("\"{}\": expected three numbers, found {}", name, value.dump()));
    return {numberOf(name, value[0], 0, high), numberOf(name, value[1], 0, high),
            numberOf(name, value[2], 0, high)};
}

struct Setting {
    std::string name;
    std::function<void(SceneState&, const json&)> set;
    std::function<json(const SceneState&)> get = nullptr; // null: not saved
};

constexpr bool kRemembered = true;

// Returns a member of the state, or of its light.
template <typename State, typename Owner, typename Value>
auto& memberOf(State& state, Value Owner::*member) {
    if constexpr (std::is_same_v<Owner, LightState>)
        return state.light.*member;
    else
        return state.*member;
}

// Makes a setting for a member; `read` converts a value, given the setting's name.
template <typename Owner, typename Value, typename Read>
Setting ofMember(const std::string& name, Value Owner::*member, bool isKept, Read read) {
    Setting setting{
        name, [=](SceneState& state, const json& value) { memberOf(state, member) = read(name, value); }};
    if (isKept) setting.get = [=](const SceneState& state) { return json(memberOf(state, member)); };
    return setting;
}

template <typename Owner, typename Number>
Setting number(const std::string& name, Number Owner::*member, float low, float high, bool isKept = false) {
    return ofMember(name, member, isKept, [=](const std::string& key, const json& value) {
        return Number(numberOf(key, value, low, high));
    });
}

template <typename Owner>
Setting flag(const std::string& name, bool Owner::*member, bool isKept = false) {
    return ofMember(name, member, isKept, [](const std::string& key, const json& value) {
        if (!value.is_boolean())
            throw Error(fmt::format("\"{}\": expected true or false, found {}", key, value.dump()));
        return value.get<bool>();
    });
}

// Makes a setting that is one of `names`, in the order of an enumeration.
template <typename Owner, typename Choice>
Setting choice(const std::string& name, Choice Owner::*member, const std::vector<std::string>& names,
               bool isKept = false) {
    Setting setting{name, [=](SceneState& state, const json& value) {
                        const auto found =
                            std::ranges::find(names, value.is_string() ? value.get<std::string>() : "");
                        if (found == names.end())
                            throw Error(fmt::format("\"{}\": expected {}, found {}", name,
                                                    fmt::join(names, " or "), value.dump()));
                        memberOf(state, member) = Choice(found - names.begin());
                    }};
    if (isKept)
        setting.get = [=](const SceneState& state) { return json(names[size_t(memberOf(state, member))]); };
    return setting;
}

// Calls `read` with every key and value of an object; throws if it returns false.
template <typename Read>
void forEachKey(const std::string& name, const json& object, Read read) {
    if (!object.is_object())
        throw Error(fmt::format("\"{}\": expected an object, found {}", name, object.dump()));
    for (const auto& [key, value] : object.items())
        if (!read(key, value))
            throw Error(
                fmt::format("\"{}\": there is no \"{}\"; docs/viewer.md lists what there is", name, key));
}

LampChoice lampFrom(const json& values) {
    LampChoice lamp;
    forEachKey("lamps", values, [&](const std::string& key, const json& value) {
        if (key == "azimuth")
            lamp.azimuth = numberOf(key, value, -360, 360);
        else if (key == "elevation")
            lamp.elevation = numberOf(key, value, -90, 90);
        else if (key == "radius")
            lamp.radius = numberOf(key, value, 0.5f, 60);
        else if (key == "brightness")
            lamp.brightness = numberOf(key, value, 0, 1000);
        else if (key == "color")
            lamp.color = colorOf(key, value, 1);
        else
            return false;
        return true;
    });
    return lamp;
}

StrokeChoice strokeFrom(const json& values) {
    StrokeChoice stroke;
    forEachKey("strokes", values, [&](const std::string& key, const json& value) {
        if (key == "azimuth")
            stroke.azimuth = numberOf(key, value, -360, 360);
        else if (key == "elevation")
            stroke.elevation = numberOf(key, value, -90, 90);
        else if (key == "radius")
            stroke.radius = numberOf(key, value, 0.5f, 180);
        else if (key == "radiance")
            stroke.radiance = colorOf(key, value, 1e6f);
        else if (key == "opacity")
            stroke.opacity = numberOf(key, value, 0, 1);
        else
            return false;
        return true;
    });
    return stroke;
}

void setSky(SceneState& state, const json& values) {
    DaySkyChoice& sky = state.light.sky;
    forEachKey("day-sky", values, [&](const std::string& key, const json& value) {
        if (key == "day")
            sky.dayOfYear = int(numberOf(key, value, 1, 365));
        else if (key == "hour")
            sky.hour = numberOf(key, value, 0, 24);
        else if (key == "latitude")
            sky.latitude = numberOf(key, value, -90, 90);
        else if (key == "turbidity")
            sky.turbidity = numberOf(key, value, 2, 10);
        else
            return false;
        return true;
    });
    const auto isDay = [](const EnvironmentChoice& c) { return c.kind == EnvironmentChoice::Kind::DaySky; };
    const auto& choices = state.light.environments;
    state.light.environment = size_t(std::ranges::find_if(choices, isDay) - choices.begin());
    state.light.file.reset();
}

void setThreshold(SceneState& state, const json& value) {
    state.light.selection = {.threshold = int(numberOf("threshold", value, 0, float(kLightMaximum)))};
}

// Sets the number of light entries; 0 selects by threshold.
void setCoefficients(SceneState& state, const json& value) {
    const int count = int(numberOf("coefficients", value, 0, float(kMaximumLightEntries)));
    LightSelection& selection = state.light.selection;
    if (count == 0)
        selection.threshold = selection.threshold.value_or(kPaperLightThreshold);
    else
        selection = {.count = count};
}

json coefficientsOf(const SceneState& state) {
    const LightSelection& selection = state.light.selection;
    return selection.threshold ? 0 : selection.count;
}

void setSamples(SceneState& state, const json& value) {
    if (value != 1 && value != 2 && value != 4 && value != 8)
        throw Error(fmt::format("\"samples\": expected 1, 2, 4 or 8, found {}", value.dump()));
    state.samples = value.get<int>();
}

// Sets the material: a name, "" for what was baked, or weights by name.
void setMaterial(SceneState& state, const json& value) {
    std::vector<WeightedMaterial> blend;
    if (value.is_string() && value != "") blend.push_back({value.get<std::string>()});
    if (value.is_object())
        for (const auto& [name, weight] : value.items())
            blend.push_back({name, numberOf(name, weight, 0, 1e6f)});
    if (!value.is_string() && blend.empty())
        throw Error(fmt::format("\"material\": expected a name, or weights by name, found {}", value.dump()));
    if (!blend.empty() &&
        std::ranges::all_of(blend, [](const WeightedMaterial& material) { return material.weight == 0; }))
        throw Error(
            fmt::format("\"material\": expected at least one weight above 0, found {}", value.dump()));
    state.material = blend;
}

void setExposure(SceneState& state, const json& value) {
    const bool isAuto = value == "auto";
    if (!isAuto) state.exposure = numberOf("exposure", value, -100, 100);
    state.exposesItself = state.wantsExposure = isAuto;
}

json exposureOf(const SceneState& state) { return state.exposesItself ? json("auto") : json(state.exposure); }

template <typename Element>
void setList(const std::string& name, std::vector<Element>& list, Element (*from)(const json&),
             const json& values) {
    if (!values.is_array() || values.size() > kMostSources)
        throw Error(fmt::format("\"{}\": expected a list of at most {} objects", name, kMostSources));
    list.clear();
    for (const json& value : values) list.push_back(from(value));
}

void setLamps(SceneState& state, const json& value) { setList("lamps", state.light.lamps, lampFrom, value); }

void setStrokes(SceneState& state, const json& value) {
    setList("strokes", state.light.strokes, strokeFrom, value);
}

const std::vector<Setting>& settings() {
    static const std::vector<Setting> all = {
        number("rotation", &LightState::rotation, -1e6f, 1e6f),
        number("gain", &LightState::environmentGain, 0, 1e6f),
        number("seconds", &LightState::seconds, 0, 1e6f),
        {"exposure", setExposure, exposureOf},
        choice("background", &SceneState::background, {"environment", "none"}, kRemembered),
        number("background-blur", &SceneState::backgroundBlur, 0, 90, kRemembered),
        choice("ground-style", &SceneState::ground, {kGroundStyleNames.begin(), kGroundStyleNames.end()},
               kRemembered),
        number("terms", &SceneState::terms, 0, 1024),
        number("split", &SceneState::split, 0, 1),
        choice("tone", &SceneState::tone, {"none", "aces", "agx"}, kRemembered),
        choice("compare", &SceneState::compare, {"off", "split", "reference", "difference"}),
        choice("inspect", &SceneState::inspect, {"off", "wireframe", "normals", "density"}),
        flag("residual", &SceneState::addsResidual),
        flag("play", &LightState::plays),
        flag("turntable", &SceneState::turns),
        flag("light-vector", &SceneState::showsLight),
        flag("panels", &SceneState::showsPanels, kRemembered),
        flag("model-panel", &SceneState::opensModel, kRemembered),
        flag("light-panel", &SceneState::opensLight, kRemembered),
        flag("material-panel", &SceneState::opensMaterial, kRemembered),
        flag("view-panel", &SceneState::opensView, kRemembered),
        flag("trust-panel", &SceneState::opensTrust, kRemembered),
        flag("help", &SceneState::showsHelp),
        flag("dark", &SceneState::isDark, kRemembered),
        flag("vsync", &SceneState::waitsForDisplay, kRemembered),
        {"coefficients", setCoefficients, coefficientsOf},
        {"threshold", setThreshold},
        {"samples", setSamples, [](const SceneState& state) { return json(state.samples); }},
        {"lamps", setLamps},
        {"strokes", setStrokes},
        {"day-sky", setSky},
        {"material", setMaterial},
    };
    return all;
}

// Applies a setting of the camera; returns false if it is not one.
bool applyToCamera(SceneState& state, const std::string& name, const json& value, const Bounds* model) {
    if (name != "azimuth" && name != "elevation" && name != "distance" && name != "fov") return false;
    if (!model) throw Error(fmt::format("\"{}\": nothing is shown yet; \"wait\" for it", name));
    Orbit& orbit = *state.orbit;
    if (name == "azimuth") orbit.azimuth = glm::radians(numberOf(name, value, -360, 360));
    if (name == "elevation") orbit.elevation = glm::radians(numberOf(name, value, -89.5f, 89.5f));
    if (name == "distance") orbit.distance = numberOf(name, value, 1e-3f, 1e3f) * model->radius();
    if (name == "fov") {
        state.fovDegrees = numberOf(name, value, 1, 170);
        orbit.verticalFov = glm::radians(state.fovDegrees);
    }
    return true;
}

} // namespace

void applySetting(SceneState& state, const std::string& name, const json& value, const Bounds* model) {
    if (applyToCamera(state, name, value, model)) return;
    const auto setting = std::ranges::find(settings(), name, &Setting::name);
    if (setting != settings().end()) return setting->set(state, value);
    std::vector<std::string_view> names = {"azimuth", "elevation", "distance", "fov", "environment"};
    for (const Setting& known : settings()) names.push_back(known.name);
    throw Error(fmt::format("no setting is called \"{}\"; did you mean \"{}\"? docs/viewer.md lists them",
                            name, nearestName(name, names)));
}

json rememberedSettings(const SceneState& state) {
    json kept = json::object();
    for (const Setting& setting : settings())
        if (setting.get) kept[setting.name] = setting.get(state);
    return kept;
}

} // namespace relume

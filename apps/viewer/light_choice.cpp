#include "apps/viewer/light_choice.h"

#include "engine/base/error.h"
#include "engine/import/json_object.h"
#include "engine/import/light_file.h"
#include "engine/light/sun_position.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

constexpr double kDegreesPerSecond = 20, kHoursPerSecond = 0.5;

vec3 radianceOf(const LampChoice& lamp) {
    // Irradiance of a surface facing the lamp is π sin² radius times its radiance.
    const float sine = std::sin(glm::radians(lamp.radius));
    return glm::min(lamp.brightness / (sine * sine) * lamp.color, vec3(kMostRadiance));
}

constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

// Returns the time as light files have it, to the second.
std::string timeOf(const DaySkyChoice& choice) {
    int month = 1, day = choice.dayOfYear;
    while (month < 12 && day > kDays[month - 1]) day -= kDays[month++ - 1];
    const int second = std::clamp(int(std::lround(3600 * double(choice.hour))), 0, 24 * 3600 - 1);
    return fmt::format("2026-{:02}-{:02}T{:02}:{:02}:{:02}Z", month, day, second / 3600, second / 60 % 60,
                       second % 60);
}

Moment momentOf(const JsonObject& sky) {
    try {
        return parseMoment(sky.requiredText("time", "a moment"));
    } catch (const UsageError& wrong) {
        throw Error(fmt::format("{}: \"time\": {}", sky.place(), wrong.what()));
    }
}

nlohmann::json listOf(vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

std::vector<StrokeChoice> strokesTo(const StrokeChoice& last, const StrokeChoice& next) {
    constexpr float kSpacing = 0.4f; // of a radius
    const float cosine =
        glm::dot(directionAt(last.azimuth, last.elevation), directionAt(next.azimuth, next.elevation));
    const float angle = glm::degrees(std::acos(std::clamp(cosine, -1.0f, 1.0f)));
    const int steps = int(angle / (kSpacing * next.radius));
    const float turn = std::remainder(next.azimuth - last.azimuth, 360.0f);
    std::vector<StrokeChoice> strokes;
    for (int step = 1; step < steps; step++) {
        // Straight on the map, as the mouse went.
        const float share = float(step) / float(steps);
        strokes.push_back(next);
        strokes.back().azimuth = std::remainder(last.azimuth + share * turn, 360.0f);
        strokes.back().elevation = glm::mix(last.elevation, next.elevation, share);
    }
    if (steps > 0) strokes.push_back(next);
    return strokes;
}

SunPlace sunPlaceOf(const DaySkyChoice& choice) {
    constexpr float kNorth = 180; // default of light files
    const SunPosition sun = sunPosition(parseMoment(timeOf(choice)), double(choice.latitude), 0);
    return {kNorth - float(sun.azimuth), float(sun.elevation)};
}

bool lightsAlike(const LightState& a, const LightState& b) {
    if (a.file != b.file || a.rotation != b.rotation || a.selection != b.selection) return false;
    if (a.file) return true;
    if (a.chosen().kind != b.chosen().kind || a.chosen().map != b.chosen().map) return false;
    return a.environmentGain == b.environmentGain && a.lamps == b.lamps && a.strokes == b.strokes &&
           (!a.isDay() || a.sky == b.sky);
}

Light lightOf(const LightState& state) {
    Light light;
    if (state.isDay()) {
        const SunPlace sun = sunPlaceOf(state.sky);
        light.sky = DaySky{.sun = directionAt(sun.azimuth, sun.elevation)};
        light.sky->turbidity = state.sky.turbidity;
        light.sky->gain = state.environmentGain;
    } else if (state.chosen().map)
        light.environments.push_back({state.chosen().map, 0, state.environmentGain, state.chosen().picture});
    for (const StrokeChoice& stroke : state.strokes)
        light.strokes.push_back({.direction = directionAt(stroke.azimuth, stroke.elevation),
                                 .angularRadius = glm::radians(stroke.radius),
                                 .radiance = stroke.radiance,
                                 .opacity = stroke.opacity});
    for (const LampChoice& lamp : state.lamps)
        light.lamps.push_back(
            {directionAt(lamp.azimuth, lamp.elevation), glm::radians(lamp.radius), radianceOf(lamp)});
    return light;
}

nlohmann::ordered_json lightFileOf(const LightState& state) {
    nlohmann::ordered_json light = nlohmann::json::object();
    if (state.isDay()) {
        light["sky"] = {{"time", timeOf(state.sky)},
                        {"latitude", state.sky.latitude},
                        {"longitude", 0},
                        {"turbidity", state.sky.turbidity},
                        {"gain", state.environmentGain}};
    } else if (state.environmentGain > 0) {
        light["environment"] = {{"gain", state.environmentGain}};
        if (state.chosen().file.empty())
            light["environment"]["built_in"] = true;
        else
            light["environment"]["file"] = std::filesystem::absolute(state.chosen().file).string();
    }
    for (const StrokeChoice& stroke : state.strokes)
        light["strokes"].push_back({{"azimuth", stroke.azimuth},
                                    {"elevation", stroke.elevation},
                                    {"radius", stroke.radius},
                                    {"radiance", listOf(stroke.radiance)},
                                    {"opacity", stroke.opacity}});
    for (const LampChoice& lamp : state.lamps)
        light["lamps"].push_back({{"azimuth", lamp.azimuth},
                                  {"elevation", lamp.elevation},
                                  {"radius", lamp.radius},
                                  {"radiance", listOf(radianceOf(lamp))}});
    return light;
}

size_t addEnvironment(LightState& state, const std::filesystem::path& file) {
    std::vector<EnvironmentChoice>& choices = state.environments;
    const std::filesystem::path whole = std::filesystem::absolute(file).lexically_normal();
    const auto known = std::ranges::find(choices, whole, &EnvironmentChoice::file);
    const auto number = size_t(known - choices.begin());
    if (known == choices.end())
        choices.push_back({EnvironmentChoice::Kind::File, file.stem().string(), whole});
    return number;
}

void setLight(LightState& state, const nlohmann::json& light, const std::string& place,
              const std::filesystem::path& folder) {
    static constexpr std::string_view kKeys[] = {"environment", "sky", "strokes", "lamps"},
                                      kEnvironmentKeys[] = {"file", "built_in", "gain"},
                                      kSkyKeys[] = {"time", "latitude", "longitude", "turbidity", "gain"},
                                      kStrokeKeys[] = {"azimuth", "elevation", "radius", "radiance",
                                                       "opacity"},
                                      kLampKeys[] = {"azimuth", "elevation", "radius", "radiance"};
    const JsonObject root(light, place, kKeys);
    LightState set = state;
    set.file.reset();
    set.strokes.clear();
    set.lamps.clear();
    set.environment = 0;
    set.environmentGain = 0;
    using Kind = EnvironmentChoice::Kind;
    if (root.find("environment") && root.find("sky")) root.fail("sky", "no such key beside \"environment\"");
    if (const nlohmann::json* json = root.find("environment")) {
        const JsonObject environment(*json, place + ": environment", kEnvironmentKeys);
        if (environment.find("built_in") && environment.find("file"))
            environment.fail("file", "no such key beside \"built_in\"");
        if (!environment.flag("built_in", false))
            set.environment =
                addEnvironment(set, folder / environment.requiredText("file", "an .exr or .hdr file"));
        set.environmentGain = environment.number("gain", 1, 0, 1e6f);
    }
    if (const nlohmann::json* json = root.find("sky")) {
        const JsonObject sky(*json, place + ": sky", kSkyKeys);
        const auto isDay = [](const EnvironmentChoice& choice) { return choice.kind == Kind::DaySky; };
        set.environment = size_t(std::ranges::find_if(set.environments, isDay) - set.environments.begin());
        set.environmentGain = sky.number("gain", 1, 0, 1e6f);
        set.sky.latitude = sky.requiredNumber("latitude", -90, 90);
        set.sky.turbidity = sky.number("turbidity", 2.5f, 2, 10);
        // The viewer's clock shows solar time, which is one hour later per 15 degrees east.
        const float longitude = sky.requiredNumber("longitude", -180, 180);
        const Moment moment = momentOf(sky);
        set.sky.hour = float(moment.hours) + longitude / 15;
        set.sky.dayOfYear = moment.day;
        for (int month = 1; month < moment.month; month++) set.sky.dayOfYear += kDays[month - 1];
        if (!(set.sky.hour >= 0 && set.sky.hour <= 24)) {
            set.sky.dayOfYear += set.sky.hour < 0 ? -1 : 1;
            set.sky.hour += set.sky.hour < 0 ? 24 : -24;
        }
        set.sky.dayOfYear = std::clamp(set.sky.dayOfYear, 1, 365);
    }
    const auto forEach = [&](const char* key, std::span<const std::string_view> keys, const auto& add) {
        const nlohmann::json* list = root.find(key);
        if (list && (!list->is_array() || list->size() > kMostSources))
            root.fail(key, fmt::format("a list of at most {} objects", kMostSources));
        for (size_t i = 0; list && i < list->size(); i++)
            add(JsonObject((*list)[i], fmt::format("{}: {}[{}]", place, key, i), keys));
    };
    forEach("strokes", kStrokeKeys, [&](const JsonObject& object) {
        set.strokes.push_back(
            {object.requiredNumber("azimuth", -360, 360), object.requiredNumber("elevation", -90, 90),
             object.requiredNumber("radius", 0.5f, 180), object.requiredVector("radiance", 0, 1e6f),
             object.number("opacity", 1, 0, 1)});
    });
    forEach("lamps", kLampKeys, [&](const JsonObject& object) {
        LampChoice lamp{object.requiredNumber("azimuth", -360, 360),
                        object.requiredNumber("elevation", -90, 90),
                        object.requiredNumber("radius", 0.5f, 60), vec3(1), 0};
        const float sine = std::sin(glm::radians(lamp.radius));
        const vec3 lit = sine * sine * object.requiredVector("radiance", 0, kMostRadiance);
        lamp.brightness = std::max({lit.x, lit.y, lit.z});
        if (lamp.brightness > 0) lamp.color = lit / lamp.brightness;
        set.lamps.push_back(lamp);
    });
    state = std::move(set);
}

void play(LightState& state, double seconds) {
    if (state.file && state.file->moves())
        state.seconds += seconds;
    else if (state.isDay())
        state.sky.hour = float(std::fmod(double(state.sky.hour) + kHoursPerSecond * seconds, 24));
    else
        state.rotation = float(std::remainder(double(state.rotation) + kDegreesPerSecond * seconds, 360));
}

} // namespace relume

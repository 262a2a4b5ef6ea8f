#include "apps/viewer/light_choice.h"

#include "engine/light/sun_position.h"

#include <cmath>

namespace relume {

namespace {

constexpr double kDegreesPerSecond = 20, kHoursPerSecond = 0.5;

vec3 radianceOf(const LampChoice& lamp) {
    // Irradiance of a surface that faces it: π sin² radius times its radiance.
    const float sine = std::sin(glm::radians(lamp.radius));
    return lamp.brightness / (sine * sine) * lamp.color;
}

nlohmann::json listOf(vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

SunPlace sunPlaceOf(const DaySkyChoice& choice) {
    constexpr float kNorth = 180; // the default of light files
    constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    int month = 1, day = choice.dayOfYear;
    while (month < 12 && day > kDays[month - 1]) day -= kDays[month++ - 1];
    const SunPosition sun = sunPosition({2026, month, day, double(choice.hour)}, double(choice.latitude), 0);
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

std::optional<nlohmann::json> lightFileOf(const LightState& state) {
    nlohmann::json light = nlohmann::json::object();
    if (state.isDay()) {
        const SunPlace sun = sunPlaceOf(state.sky);
        light["sky"] = {{"sun", {{"azimuth", sun.azimuth}, {"elevation", sun.elevation}}},
                        {"turbidity", state.sky.turbidity},
                        {"gain", state.environmentGain}};
    } else if (state.environmentGain > 0) {
        if (state.chosen().file.empty()) return std::nullopt;
        light["environment"] = {{"file", std::filesystem::absolute(state.chosen().file).string()},
                                {"gain", state.environmentGain}};
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

void play(LightState& state, double seconds) {
    if (state.file && state.file->moves())
        state.seconds += seconds;
    else if (state.isDay())
        state.sky.hour = float(std::fmod(double(state.sky.hour) + kHoursPerSecond * seconds, 24));
    else
        state.rotation = float(std::remainder(double(state.rotation) + kDegreesPerSecond * seconds, 360));
}

} // namespace relume

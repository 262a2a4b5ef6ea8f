// What lights the object, as hands choose it, and the light that it stands for.
#pragma once

#include "engine/import/moving_light.h"
#include "engine/light/light_selection.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relume {

// An environment that can be chosen.
struct EnvironmentChoice {
    enum class Kind { BuiltIn, DaySky, File } kind;
    std::string name;
    std::filesystem::path file = {};
    std::shared_ptr<const Environment> map = nullptr; // prepared; null until it was read, and of a day sky
    std::shared_ptr<const Environment> picture = nullptr; // makePicture(), there when `map` is
    bool isRead = false;                                  // or being read, or could not be
};

// A day sky as it is chosen, on the meridian of its time: at 12 the sun is highest.
struct DaySkyChoice {
    int dayOfYear = 172; // 1 to 365
    float hour = 15;     // 0 to 24
    float latitude = 48; // degrees
    float turbidity = 2.5f;

    bool operator==(const DaySkyChoice&) const = default;
};

// A lamp as it is dragged: degrees; radiance such that white that faces it is lit to `brightness` times
// `color`.
struct LampChoice {
    float azimuth = 40, elevation = 40, radius = 8;
    vec3 color{1, 0.9f, 0.75f};
    float brightness = 1;

    bool operator==(const LampChoice&) const = default;
};

// A touch of the brush, in degrees.
struct StrokeChoice {
    float azimuth = 0, elevation = 0, radius = 15;
    vec3 radiance{1};
    float opacity = 1;

    bool operator==(const StrokeChoice&) const = default;
};

struct LightState {
    std::vector<EnvironmentChoice> environments; // at least one
    size_t environment = 0;
    float environmentGain = 1;
    DaySkyChoice sky;
    std::vector<LampChoice> lamps;
    std::vector<StrokeChoice> strokes; // over environment or sky
    float rotation = 0;                // of all of it, degrees, as `relume render --rotate`
    // A light file, instead of environment, lamps and strokes.
    std::shared_ptr<MovingLight> file;
    std::filesystem::path fileName;
    double seconds = 0; // of a light file that moves
    bool plays = false;
    LightSelection selection;

    const EnvironmentChoice& chosen() const { return environments[environment]; }
    bool isDay() const { return !file && chosen().kind == EnvironmentChoice::Kind::DaySky; }
    // The map that it needs is there, if it needs one.
    bool isReady() const { return file || isDay() || chosen().map; }
};

// Where the sun of a day sky stands: azimuth and elevation as directionAt() has them.
struct SunPlace {
    float azimuth, elevation;
};
SunPlace sunPlaceOf(const DaySkyChoice& choice);

// Whether two states light alike, but for the time of a light file.
bool lightsAlike(const LightState& a, const LightState& b);

// The light, not of a light file, and not turned.
Light lightOf(const LightState& state);

// The same as a light file has it (docs/light_format.md).
nlohmann::ordered_json lightFileOf(const LightState& state);

// Sets what a light file's content says, whose relative paths start at `folder`: one environment or day sky,
// strokes and lamps, as lightFileOf() gives them. `place` names it in errors. Throws Error, for other light
// too, which can be shown but not be edited.
void setLight(LightState& state, const nlohmann::json& light, const std::string& place,
              const std::filesystem::path& folder);

// Returns the number of a file among the environments to choose from, and adds it if it is not there.
size_t addEnvironment(LightState& state, const std::filesystem::path& file);

// Some of the light moves on by so many seconds: a light file's time, the day (an hour in two seconds), or
// else all of it turns.
void play(LightState& state, double seconds);

} // namespace relume

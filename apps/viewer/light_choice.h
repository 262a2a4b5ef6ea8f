// The light as the user sets it, and its conversion to a Light.
#pragma once

#include "engine/import/moving_light.h"
#include "engine/light/light_selection.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relume {

// An environment that can be chosen.
struct EnvironmentChoice {
    enum class Kind { BuiltIn, DaySky, File } kind;
    std::string name;
    std::filesystem::path file = {};
    std::shared_ptr<const Environment> map = nullptr; // prepared; null before it was read, and for a day sky
    std::shared_ptr<const Environment> picture = nullptr; // makePicture(); set together with `map`
    bool isRead = false;                                  // or is being read, or could not be read
};

// The parameters of a day sky. Hours are local solar time: at 12 the sun is highest.
struct DaySkyChoice {
    int dayOfYear = 172; // 1 to 365
    float hour = 15;     // 0 to 24
    float latitude = 48; // degrees
    float turbidity = 2.5f;

    bool operator==(const DaySkyChoice&) const = default;
};

// A lamp as the user sets it; angles in degrees. Its radiance lights white that faces it to `brightness` ·
// `color`.
struct LampChoice {
    float azimuth = 40, elevation = 40, radius = 8;
    vec3 color{1, 0.9f, 0.75f};
    float brightness = 1;

    bool operator==(const LampChoice&) const = default;
};

// A stroke of the brush; angles in degrees.
struct StrokeChoice {
    float azimuth = 0, elevation = 0, radius = 15;
    vec3 radiance{1};
    float opacity = 1;

    bool operator==(const StrokeChoice&) const = default;
};

// Returns the strokes by which a brush goes on from `last` to `next`: close enough to leave no gaps, the last
// of them `next`; none if it is so close to `last` that it would add little.
std::vector<StrokeChoice> strokesTo(const StrokeChoice& last, const StrokeChoice& next);

// Everything that lights the object.
struct LightState {
    std::vector<EnvironmentChoice> environments; // at least one
    size_t environment = 0;
    float environmentGain = 1;
    DaySkyChoice sky;
    std::vector<LampChoice> lamps;
    std::vector<StrokeChoice> strokes; // painted over environment or sky
    float rotation = 0;                // of the whole light, degrees, as `relume render --rotate`
    // A light file, which replaces environment, lamps and strokes.
    std::shared_ptr<MovingLight> file;
    std::filesystem::path fileName;
    double seconds = 0; // time in a moving light file
    bool plays = false;
    LightSelection selection;

    const EnvironmentChoice& chosen() const { return environments[environment]; }
    bool isDay() const { return !file && chosen().kind == EnvironmentChoice::Kind::DaySky; }
    // Returns whether the map that the light needs, if any, has been read.
    bool isReady() const { return file || isDay() || chosen().map; }
};

// The position of the sun of a day sky, in degrees, as directionAt() takes it.
struct SunPlace {
    float azimuth, elevation;
};
SunPlace sunPlaceOf(const DaySkyChoice& choice);

// Returns whether two states give the same light, ignoring the time of a light file.
bool lightsAlike(const LightState& a, const LightState& b);

// Returns the light, without a light file and without rotation.
Light lightOf(const LightState& state);

// Returns the same as the content of a light file (docs/light_format.md).
nlohmann::ordered_json lightFileOf(const LightState& state);

// Sets the state from a light file's content, whose relative paths start at `folder`: one environment or day
// sky, strokes and lamps, as lightFileOf() writes them. `place` names it in errors. Throws Error, also for
// other kinds of light, which can be shown but not edited.
void setLight(LightState& state, const nlohmann::json& light, const std::string& place,
              const std::filesystem::path& folder);

// Returns the index of a file among the environments, to which it is added if missing.
size_t addEnvironment(LightState& state, const std::filesystem::path& file);

// Advances the light by `seconds`: a moving light file's time, the time of day (an hour in two seconds), or
// else the rotation.
void play(LightState& state, double seconds);

} // namespace relume

// Reads the JSON of docs/light_format.md.
#include "engine/import/light_file.h"

#include "engine/base/error.h"
#include "engine/import/json_object.h"
#include "engine/import/light_values.h"
#include "engine/light/sun_position.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::json;
using Keys = std::span<const std::string_view>;

constexpr float kMostDegrees = 36000;
constexpr float kSequenceRate = 24; // files per second
constexpr float kMostHours = 100;   // hours of the day per second

vec3 directionOf(const JsonObject& object) {
    const float azimuth = object.requiredNumber("azimuth", -kMostDegrees, kMostDegrees);
    return directionAt(azimuth, object.requiredNumber("elevation", -90, 90));
}

float radiusOf(const JsonObject& object) {
    return std::min(glm::radians(object.requiredNumber("radius", kSmallestLampRadius, 180)), kPi);
}

// Adds an environment, or the two images of a sequence that the moment lies between.
void addEnvironment(const JsonObject& object, const LightMoment& moment, float share, Light& light) {
    const float rotation = glm::radians(object.number("rotate", 0, -kMostDegrees, kMostDegrees));
    const float gain = share * object.number("gain", 1, 0, kMostGain);
    const auto add = [&](const std::filesystem::path& file, float weight) {
        if (weight > 0)
            light.environments.push_back(
                {moment.files.map(file), rotation, weight * gain, moment.files.picture(file)});
    };
    if (object.find("sequence") && object.find("file"))
        object.fail("sequence", "no such key beside \"file\"");
    if (object.flag("built_in", false)) {
        for (const char* key : {"file", "sequence", "rate"})
            if (object.find(key)) object.fail(key, "no such key beside \"built_in\"");
        return add({}, 1);
    }
    if (!object.find("sequence")) {
        if (object.find("rate")) object.fail("rate", "no such key without \"sequence\"");
        add(moment.folder /
                object.requiredText("file", "an .exr or .hdr file; or \"sequence\", or \"built_in\""),
            1);
        return;
    }
    const std::string pattern = object.requiredText("sequence", "file names with # for their number");
    const auto& files = moment.files.sequence(moment.folder / pattern);
    const double rate = double(object.number("rate", kSequenceRate, 1e-3f, 1e3f));
    const double place = std::min(moment.seconds * rate, double(files.size() - 1));
    const auto first = size_t(place);
    const auto weight = float(place - double(first));
    add(files[first], 1 - weight);
    if (weight > 0) add(files[first + 1], weight);
}

void readEnvironments(const JsonObject& root, const LightMoment& moment, Light& light) {
    static constexpr std::string_view kKeys[] = {"file", "sequence", "rate", "built_in", "rotate", "gain"},
                                      kBlendKeys[] = {"file",   "sequence", "rate",  "built_in",
                                                      "rotate", "gain",     "weight"};
    const Json* first = root.find("environment");
    const Json* second = root.find("blend");
    if (second && !first) root.fail("environment", "one that \"blend\" is mixed into");
    std::optional<JsonObject> blend;
    float weight = 0;
    if (second) {
        blend.emplace(*second, root.place() + ": blend", kBlendKeys);
        weight = blend->requiredNumber("weight", 0, 1);
    }
    if (first)
        addEnvironment(JsonObject(*first, root.place() + ": environment", kKeys), moment, 1 - weight, light);
    if (blend) addEnvironment(*blend, moment, weight, light);
}

vec3 readSun(const JsonObject& sky, double seconds) {
    static constexpr std::string_view kKeys[] = {"azimuth", "elevation"};
    const Json* sun = sky.find("sun");
    const Json* time = sky.find("time");
    if (!sun == !time)
        sky.fail("sun", "its azimuth and elevation, or \"time\", \"latitude\" and \"longitude\"");
    if (sun) {
        for (const char* key : {"latitude", "longitude", "north", "hours_per_second"})
            if (sky.find(key)) sky.fail(key, "no such key beside \"sun\"");
        return directionOf(JsonObject(*sun, sky.place() + ": sun", kKeys));
    }
    const float latitude = sky.requiredNumber("latitude", -90, 90);
    const float longitude = sky.requiredNumber("longitude", -180, 180);
    const float north = sky.number("north", 180, -kMostDegrees, kMostDegrees);
    Moment moment;
    try {
        moment = parseMoment(sky.requiredText("time", "a moment"));
    } catch (const UsageError& wrong) {
        throw Error(fmt::format("{}: \"time\": {}", sky.place(), wrong.what()));
    }
    moment.hours += seconds * double(sky.number("hours_per_second", 0, -kMostHours, kMostHours));
    const SunPosition position = sunPosition(moment, double(latitude), double(longitude));
    return directionAt(north - float(position.azimuth), float(position.elevation));
}

void readSky(const JsonObject& root, const LightMoment& moment, Light& light) {
    static constexpr std::string_view kKeys[] = {"sun",   "time", "hours_per_second", "latitude", "longitude",
                                                 "north", "disc", "turbidity",        "ground",   "gain"};
    const Json* json = root.find("sky");
    if (!json) return;
    const JsonObject sky(*json, root.place() + ": sky", kKeys);
    DaySky day{.sun = readSun(sky, moment.seconds)};
    day.hasDisc = sky.flag("disc", day.hasDisc);
    day.turbidity = sky.number("turbidity", day.turbidity, 2, 10);
    day.ground = sky.vector("ground", day.ground, 0, 1);
    day.gain = sky.number("gain", day.gain, 0, kMostGain);
    light.sky = day;
}

// Calls `read` with each object of a list.
template <typename Read>
void forEach(const JsonObject& root, const char* key, Keys keys, Read read) {
    const Json* list = root.find(key);
    if (!list) return;
    if (!list->is_array() || list->size() > kMostSources)
        root.fail(key, fmt::format("a list of at most {} objects", kMostSources));
    for (size_t i = 0; i < list->size(); i++)
        read(JsonObject((*list)[i], fmt::format("{}: {}[{}]", root.place(), key, i), keys));
}

} // namespace

MovingLight readLight(const std::filesystem::path& path) {
    return {readJsonText(path), path.string(), path.parent_path()};
}

Light makeLight(const Json& values, const LightMoment& moment) {
    static constexpr std::string_view kKeys[] = {"environment", "blend", "sky",
                                                 "strokes",     "lamps", "distant"};
    static constexpr std::string_view kStrokeKeys[] = {"azimuth",  "elevation", "radius",
                                                       "radiance", "softness",  "opacity"};
    static constexpr std::string_view kLampKeys[] = {"azimuth", "elevation", "radius", "radiance"};
    static constexpr std::string_view kDistantKeys[] = {"azimuth", "elevation", "irradiance"};
    const JsonObject root(values, moment.name, kKeys);
    Light light;
    readSky(root, moment, light);
    forEach(root, "strokes", kStrokeKeys, [&](const JsonObject& object) {
        light.strokes.push_back({.direction = directionOf(object),
                                 .angularRadius = radiusOf(object),
                                 .radiance = object.requiredVector("radiance", 0, kMostRadiance),
                                 .softness = object.number("softness", 0.5f, 0, 1),
                                 .opacity = object.number("opacity", 1, 0, 1)});
    });
    forEach(root, "lamps", kLampKeys, [&](const JsonObject& object) {
        light.lamps.push_back(
            {directionOf(object), radiusOf(object), object.requiredVector("radiance", 0, kMostRadiance)});
    });
    forEach(root, "distant", kDistantKeys, [&](const JsonObject& object) {
        light.distant.push_back({directionOf(object), object.requiredVector("irradiance", 0, kMostRadiance)});
    });
    readEnvironments(root, moment, light); // last, since reading images takes longest
    return light;
}

} // namespace relume

#include "apps/viewer/session.h"

#include "apps/viewer/opened_file.h"
#include "apps/viewer/screenshot.h"
#include "engine/base/error.h"
#include "engine/import/json_object.h"
#include "engine/import/light_file.h"
#include "engine/import/session_file.h"

#include <algorithm>
#include <charconv>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::json;

constexpr float kLargest = 1e6f, kMostDegrees = 1e6f, kMostWeight = 1e6f;

// Reads one of `names`, which are in the order of an enumeration.
template <typename Choice>
Choice choiceOf(const JsonObject& object, const char* key, Choice fallback,
                std::initializer_list<std::string_view> names, std::string_view expected) {
    if (!object.find(key)) return fallback;
    const auto found = std::ranges::find(names, std::string_view(object.text(key, "")));
    if (found == names.end()) object.fail(key, expected);
    return Choice(found - names.begin());
}

int wholeOf(const JsonObject& object, const char* key, int fallback, int low, int high) {
    const float number = object.number(key, float(fallback), float(low), float(high));
    if (number != float(int(number))) object.fail(key, "a whole number");
    return int(number);
}

// Reads material names, with optional weights: "gold=0.5". Takes what `relume render` takes.
std::vector<WeightedMaterial> materialOf(const JsonObject& object) {
    constexpr const char* kExpected = "names, or \"NAME=WEIGHT\", each once, with a weight above 0";
    std::vector<WeightedMaterial> material;
    float sum = 0;
    if (!object.find("material")) return material;
    for (const Json& value : *object.find("material")) {
        const auto text = value.get<std::string>();
        const size_t equals = text.rfind('=');
        WeightedMaterial each{text.substr(0, equals)};
        if (equals != std::string::npos) {
            const char* const end = text.data() + text.size();
            const auto [rest, failure] = std::from_chars(text.data() + equals + 1, end, each.weight);
            if (failure != std::errc() || rest != end || !(each.weight >= 0 && each.weight <= kMostWeight))
                object.fail("material", kExpected);
        }
        if (std::ranges::find(material, each.name, &WeightedMaterial::name) != material.end())
            object.fail("material", kExpected);
        sum += each.weight;
        material.push_back(each);
    }
    if (!(sum > 0)) object.fail("material", kExpected);
    return material;
}

void setLight(const JsonObject& object, LightState& light) {
    light.rotation = object.number("rotate", 0, -kMostDegrees, kMostDegrees);
    light.selection = {.count =
                           wholeOf(object, "coefficients", LightSelection().count, 1, kMaximumLightEntries)};
    if (object.find("threshold"))
        light.selection = {.threshold = wholeOf(object, "threshold", 0, 0, int(kLightMaximum))};
    light.plays = false;
    const Json* given = object.find("light");
    if (given && given->is_string()) {
        const std::filesystem::path file = given->get<std::string>();
        auto moving = std::make_shared<MovingLight>(readLight(file));
        moving->keepPictures();
        light.file = moving;
        light.fileName = file;
        object.number("time", 0, 0, 1e6f);
        light.seconds = object.find("time") ? object.find("time")->get<double>() : 0;
    } else if (given) {
        setLight(light, *given, object.place() + ": light", "");
    } else {
        const std::string environment = object.text("environment", "");
        Json described{{"built_in", true}};
        if (!environment.empty()) described = {{"file", environment}};
        setLight(light, {{"environment", described}}, object.place(), "");
    }
}

} // namespace

nlohmann::ordered_json sessionOf(const SceneState& state, GroundStyle ground,
                                 const std::filesystem::path& bake, const std::filesystem::path& input,
                                 ivec2 size) {
    nlohmann::ordered_json session{{"session", 1}, {"bake", std::filesystem::absolute(bake).string()}};
    if (!input.empty()) session["model"] = input.string();
    session["size"] = fmt::format("{}x{}", size.x, size.y);
    session.update(renderOptions(state, ground, Drawn::Picture));
    // Say what a picture shows by default, since linear images do not.
    if (ground != GroundStyle::Whole) session["ground-style"] = kGroundStyleNames[size_t(ground)];
    if (state.light.file)
        session["light"] = std::filesystem::absolute(state.light.fileName).string();
    else if (needsLightFile(state.light))
        session["light"] = lightFileOf(state.light);
    return session;
}

Session readSession(const std::filesystem::path& file, const SceneState& state) {
    const Json content = readSessionFile(file);
    const JsonObject object(content, file.string(), kSessionKeys);
    Session session{.opened = object.text("bake", ""), .state = state};
    const std::filesystem::path model = object.text("model", "");
    std::error_code failure;
    if (!model.empty() && std::filesystem::exists(model, failure)) session.opened = model;
    const FileKind kind = kindOf(session.opened);
    if (kind != FileKind::Bake && kind != FileKind::Bakeable)
        throw Error(fmt::format("{}: expected a bake, a mesh or a scene to open, found {}", file.string(),
                                session.opened.string()));
    if (!std::filesystem::exists(session.opened, failure))
        throw Error(fmt::format("{}: {} is not there; bake it, or name another \"bake\"", file.string(),
                                session.opened.string()));
    session.camera = {object.vector("eye", vec3(0), -kLargest, kLargest),
                      object.vector("target", vec3(0), -kLargest, kLargest),
                      glm::radians(object.number("fov", 35, 1, 170))};
    session.material = materialOf(object);

    SceneState& set = session.state;
    setLight(object, set.light);
    set.turns = false;
    set.compare = Compare::Off;
    set.inspect = Inspect::Off;
    set.fovDegrees = object.number("fov", 35, 1, 170);
    set.samples = wholeOf(object, "samples", kDefaultSamples, 1, 8);
    if (set.samples == 3 || (set.samples > 4 && set.samples < 8)) object.fail("samples", "1, 2, 4 or 8");
    set.terms = wholeOf(object, "terms", 0, 0, 1024);
    set.addsResidual = choiceOf(object, "residual", 0, {"on", "off"}, "\"on\" or \"off\"") == 0;
    set.exposure = object.number("exposure", 0, -100, 100);
    set.exposesItself = set.wantsExposure = !object.find("exposure");
    set.tone =
        choiceOf(object, "tone", ToneCurve::Agx, {"none", "aces", "agx"}, "\"none\", \"aces\" or \"agx\"");
    set.background = choiceOf(object, "background", BackgroundKind::Environment, {"environment", "none"},
                              "\"environment\" or \"none\"");
    set.backgroundBlur = object.number("background-blur", 0, 0, 90);
    set.ground = choiceOf(object, "ground-style", GroundStyle::Shadow, {"whole", "fade", "shadow"},
                          "\"whole\", \"fade\" or \"shadow\"");
    return session;
}

} // namespace relume

#include "apps/viewer/settings.h"

#include "engine/base/error.h"

#include <algorithm>
#include <map>

namespace relume {

namespace {

using nlohmann::json;

float numberOf(const std::string& name, const json& value, float low, float high) {
    if (!value.is_number() || !(value.get<float>() >= low && value.get<float>() <= high))
        throw Error("\"{}\": expected a number from {} to {}, found {}", name, low, high, value.dump());
    return value.get<float>();
}

LampChoice lampFrom(const json& value) {
    LampChoice lamp;
    for (const auto& [name, number] : value.items()) {
        if (name == "azimuth")
            lamp.azimuth = numberOf(name, number, -360, 360);
        else if (name == "elevation")
            lamp.elevation = numberOf(name, number, -90, 90);
        else if (name == "radius")
            lamp.radius = numberOf(name, number, 0.5f, 60);
        else if (name == "brightness")
            lamp.brightness = numberOf(name, number, 0, 1000);
        else
            throw Error("\"lamps\": expected azimuth, elevation, radius and brightness, found \"{}\"", name);
    }
    return lamp;
}

// True: it was one of the camera.
bool applyToCamera(SceneState& state, const std::string& name, const json& value, const Bounds* model) {
    if (name != "azimuth" && name != "elevation" && name != "distance" && name != "fov") return false;
    if (!model) throw Error("\"{}\": nothing is shown yet; \"wait\" for it", name);
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
    const std::map<std::string, bool*> flags = {{"panels", &state.showsPanels},
                                                {"help", &state.showsHelp},
                                                {"dark", &state.isDark},
                                                {"turntable", &state.turns}};
    if (applyToCamera(state, name, value, model)) return;
    if (const auto flag = flags.find(name); flag != flags.end())
        *flag->second = value.get<bool>();
    else if (name == "rotation")
        state.light.rotation = numberOf(name, value, -1e6f, 1e6f);
    else if (name == "threshold")
        state.light.selection.threshold = int(numberOf(name, value, 0, float(kLightMaximum)));
    else if (name == "environment") // "sky"
        state.light.environment = 0;
    else if (name == "lamps") {
        state.light.lamps.clear();
        for (const json& lamp : value) state.light.lamps.push_back(lampFrom(lamp));
    } else if (name == "seconds")
        state.light.seconds = double(numberOf(name, value, 0, 1e6f));
    else if (name == "material")
        state.material = value.get<std::string>();
    else if (name == "exposure")
        state.exposure = numberOf(name, value, -100, 100);
    else if (name == "tone") {
        const std::optional<ToneCurve> curve = toneCurveFromName(value.get<std::string>());
        if (!curve) throw Error("\"tone\": expected none, aces or agx, found {}", value.dump());
        state.tone = *curve;
    } else
        throw Error("no setting is called \"{}\"; docs/viewer.md lists them", name);
}

} // namespace relume

// What is looked at, and how: what controls and scripts change, and frames show.
#pragma once

#include "apps/viewer/orbit.h"
#include "engine/light/light_selection.h"
#include "engine/light/moving_light.h"
#include "engine/render/tone_map.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace relume {

// An environment that can be chosen.
struct EnvironmentChoice {
    std::string name;
    std::filesystem::path file;             // empty: the built-in sky
    std::shared_ptr<const Environment> map; // prepared; null until it was read
    bool isRead = false;                    // or being read
};

// A lamp as it is dragged: degrees; radiance such that white that faces it is lit to `brightness` times
// `color`.
struct LampChoice {
    float azimuth = 40, elevation = 40, radius = 8;
    vec3 color{1, 0.9f, 0.75f};
    float brightness = 1;

    bool operator==(const LampChoice&) const = default;
};
Lamp lampOf(const LampChoice& choice);

struct LightState {
    std::vector<EnvironmentChoice> environments;
    size_t environment = 0;
    float rotation = 0; // degrees, as `relume render --rotate`
    float environmentGain = 1;
    std::vector<LampChoice> lamps;
    std::shared_ptr<MovingLight> file; // a light file, instead of environment and lamps
    std::filesystem::path fileName;
    double seconds = 0; // of a light that moves
    bool plays = false;
    LightSelection selection;
};

struct SceneState {
    std::optional<Orbit> orbit; // none: the model's default view
    float fovDegrees = 35;
    LightState light;
    std::string material; // empty: as it was baked
    ToneCurve tone = ToneCurve::Agx;
    float exposure = 0; // stops
    bool turns = false; // turntable
    bool showsPanels = true, showsHelp = false, isDark = true;
};

} // namespace relume

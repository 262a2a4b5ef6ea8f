// The state that controls and scripts change and frames show: camera, light, materials, picture and panels.
#pragma once

#include "apps/viewer/light_choice.h"
#include "apps/viewer/orbit.h"
#include "engine/render/appearance.h"
#include "engine/render/tone_map.h"
#include "engine/render/view_pass.h"

namespace relume {

// How the reference image of the view is shown (comparison.h).
enum class Compare { Off, Split, Reference, Difference };

// The background of the view: the light, or the window's own color.
enum class BackgroundKind { Environment, None };

// The brush that paints on the environment. Angles are in degrees.
struct Brush {
    bool isInHand = false;
    float radius = 15, brightness = 2, opacity = 1;
    vec3 color{1};
};

struct SceneState {
    std::optional<Orbit> orbit; // none: the default view of the model
    bool keepsOrbit = false;    // also when the next model is shown
    float fovDegrees = 35;
    LightState light;
    Brush brush;
    std::vector<WeightedMaterial> material; // bound to parts; empty: as baked
    std::optional<size_t> picked;           // part whose materials come first in the panel
    int terms = 0;                          // number of terms summed, of the model's K; 0: all
    bool addsResidual = true;               // draw with the residual
    int samples = kDefaultSamples;          // per pixel: 1, 2, 4 or 8
    ToneCurve tone = ToneCurve::Agx;
    float exposure = 0; // stops
    // Automatic exposure: chosen for the object when model, environment or light file change, and when
    // `wantsExposure`.
    bool exposesItself = true, wantsExposure = true;
    BackgroundKind background = BackgroundKind::Environment;
    float backgroundBlur = 0;                 // degrees
    GroundStyle ground = GroundStyle::Shadow; // if there is a background
    Inspect inspect = Inspect::Off;
    Compare compare = Compare::Off;
    float split = 0.5f;      // share of the window's width: relit image to its left, reference to its right
    bool turns = false;      // turntable
    bool showsLight = false; // the light vector's panel
    bool showsExplanation = false; // the panel of the explained vertex
    bool waitsForDisplay = true;   // vertical synchronization
    bool showsPanels = true, showsHelp = false, isDark = true;
    // Unfolded sections of the main panel.
    bool opensModel = false, opensLight = true, opensMaterial = true, opensView = false, opensTrust = true;
};

// Advances from one material to the next, from the last to the default appearance, and from that to the
// first.
void bindNextMaterial(SceneState& state, const std::vector<std::string>& names);

// Binds a blend to the parts that have the materials `all`, in place of any of these; other parts keep
// theirs.
void bindBlend(SceneState& state, const std::vector<std::string>& all,
               const std::vector<WeightedMaterial>& blend);

// Increases or decreases the number of terms, from 1 to `most`.
void addTerms(SceneState& state, int more, int most);

} // namespace relume

// What is looked at, and how: what controls and scripts change, and frames show.
#pragma once

#include "apps/viewer/light_choice.h"
#include "apps/viewer/orbit.h"
#include "engine/render/appearance.h"
#include "engine/render/tone_map.h"
#include "engine/render/view_pass.h"

namespace relume {

// What is shown of the reference image of the same view (comparison.h).
enum class Compare { Off, Split, Reference, Difference };

// The background of the view: the light, or the window's own color.
enum class Behind { Environment, None };

// What paints on the environment. Degrees.
struct Brush {
    bool isInHand = false;
    float radius = 15, brightness = 2, opacity = 1;
    vec3 color{1};
};

struct SceneState {
    std::optional<Orbit> orbit; // none: the model's default view
    bool keepsOrbit = false;    // also for the model that is shown next, whatever it is
    float fovDegrees = 35;
    LightState light;
    Brush brush;
    std::vector<WeightedMaterial> material; // bound to parts; empty: as it was baked
    std::optional<size_t> picked;           // the part whose materials are at hand
    int terms = 0;                          // that are summed, of a model's K; 0: all
    bool addsResidual = true;               // what these leave of the BRDF is added
    int samples = kDefaultSamples;          // a pixel: 1, 2, 4 or 8
    ToneCurve tone = ToneCurve::Agx;
    float exposure = 0; // stops
    // They are what the object asks for: found again for another model, environment or light file, and when
    // asked for.
    bool exposesItself = true, wantsExposure = true;
    Behind background = Behind::Environment;
    float backgroundBlur = 0; // degrees
    bool fadesGround = true;  // where there is a background
    Inspect inspect = Inspect::Off;
    Compare compare = Compare::Off;
    float split = 0.5f;          // of the window's width: relit left of it, the reference right
    bool turns = false;          // turntable
    bool showsLight = false;     // the panel of the light vector
    bool showsWhy = false;       // the panel of the probed vertex
    bool waitsForDisplay = true; // vertical synchronisation
    bool showsPanels = true, showsHelp = false, isDark = true;
    // Sections of the main panel that are unfolded.
    bool opensModel = false, opensLight = true, opensMaterial = true, opensView = false, opensTrust = true;
};

// From one of these materials to the next, from the last to what was baked, from that to the first.
void bindNextMaterial(SceneState& state, const std::vector<std::string>& names);

// Binds a blend to the parts that have the materials `all`, instead of any of these; other parts keep theirs.
void bindBlend(SceneState& state, const std::vector<std::string>& all,
               const std::vector<WeightedMaterial>& blend);

// More of `most` terms, or fewer: at least one.
void addTerms(SceneState& state, int more, int most);

} // namespace relume

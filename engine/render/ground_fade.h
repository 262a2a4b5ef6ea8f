// How a ground is drawn in front of a background: as it is, faded so that its edge is not seen, or as the
// shadow that falls on it.
#pragma once

#include "engine/transport/asset.h"

#include <array>
#include <optional>

namespace relume {

enum class GroundStyle {
    Whole,  // like any part
    Fade,   // ends around the object, by GroundFade
    Shadow, // fades likewise, and is black with alpha by shadowAlpha(), so that it darkens a background as a
            // shadow does (Debevec: Rendering Synthetic Objects into Real Scenes, 1998, but with luminance
            // for color); not seen from below
};

// Names of the styles, in their order, in files and on the command line.
constexpr std::array<const char*, 3> kGroundStyleNames = {"whole", "fade", "shadow"};

// How a ground fades: its coverage depends on the distance from a vertical axis through the object, 1 up to
// `inner`, falling to 0 at `outer`.
struct GroundFade {
    size_t part; // the ground
    vec2 center; // x, z
    float inner, outer;
    bool isShadow; // whether only its shadow is drawn
    float height;  // y of its lowest point

    // Returns whether the ground, shown as its shadow alone, is hidden because the eye is below it.
    bool isHiddenFrom(vec3 eye) const { return isShadow && eye.y < height; }
};

// Returns the alpha of a ground's shadow from the radiance that the ground reflects and what it would reflect
// if nothing cast shadows: 1 - their ratio, by luminance, less what errors of transport alone can darken.
// GLSL twin: shadowAlpha() in shaders/view_shade.frag.
float shadowAlpha(vec3 radiance, vec3 unshadowed);

// Returns the part called "ground", or none.
std::optional<size_t> groundOf(const Asset& asset);

// Makes the fade from the object's radius to the ground's nearest edge. Returns none for GroundStyle::Whole,
// without a ground, or if the object's center is not over it. A ground that is not flat would hide what is
// behind it, and fades instead of showing its shadow alone.
std::optional<GroundFade> makeGroundFade(const Asset& asset, GroundStyle style);

// Returns the ground's coverage at a point, in [0, 1]. GLSL twin: groundCoverage() in
// shaders/view_shade.frag.
float groundCoverage(const GroundFade& fade, vec3 position);

} // namespace relume

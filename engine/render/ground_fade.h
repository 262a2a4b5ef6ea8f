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
    Shadow, // fades likewise, and is black with an alpha of 1 - the lit share of its own radiance
            // (litShare()), so that it darkens a background as a shadow does (Debevec: Rendering Synthetic
            // Objects into Real Scenes, 1998, with luminance in place of color)
};

// Names of the styles, in their order, in files and on the command line.
constexpr std::array<const char*, 3> kGroundStyleNames = {"whole", "fade", "shadow"};

// The ground's coverage by distance from a vertical axis through the object: 1 up to `inner`, falling to 0 at
// `outer`.
struct GroundFade {
    size_t part; // the ground
    vec2 center; // x, z
    float inner, outer;
    bool isShadow; // GroundStyle::Shadow
};

// Returns the part called "ground", or none.
std::optional<size_t> groundOf(const Asset& asset);

// Makes the fade from the object's radius to the ground's nearest edge. Returns none for GroundStyle::Whole,
// without a ground, or if the object's center is not over it.
std::optional<GroundFade> makeGroundFade(const Asset& asset, GroundStyle style);

// Returns the ground's coverage at a point, in [0, 1]. GLSL twin: groundCoverage() in
// shaders/view_shade.frag.
float groundCoverage(const GroundFade& fade, vec3 position);

} // namespace relume

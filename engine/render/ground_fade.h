// The fade of a ground into the background, so that its edge is not seen.
#pragma once

#include "engine/transport/asset.h"

namespace relume {

// The ground's coverage by distance from a vertical axis through the object: 1 up to `inner`, falling to 0 at
// `outer`.
struct GroundFade {
    size_t part; // the ground
    vec2 center; // x, z
    float inner, outer;
};

// Makes the fade from the object's radius to the ground's nearest edge. Returns none if no part is called
// "ground", or if the object's center is not over it.
std::optional<GroundFade> makeGroundFade(const Asset& asset);

// Returns the ground's coverage at a point, in [0, 1]. GLSL twin: groundCoverage() in
// shaders/view_shade.frag.
float groundCoverage(const GroundFade& fade, vec3 position);

} // namespace relume

// Samples directions near the mirror direction of a view. The lobes do not adapt to the BRDF: there is one
// each for broad, glossy and nearly mirror-like reflection.
#pragma once

#include "engine/math/hashed_numbers.h"
#include "engine/math/vector.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {

inline constexpr std::array kLobeWidths = {0.1f, 0.01f, 0.001f};

// Returns the unit vector at this cosine from the z axis; `turn` is its azimuth, from 0 to 1.
inline vec3 onCone(float cosine, float turn) {
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), angle = 2 * kPi * turn;
    return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

// Returns the density, in sr⁻¹, of a direction at cosine c from the axis, with t = (1 - c) / 2: w (1 + w) /
// (4π (t + w)²). Half of all directions have t < w, about; the rest reach everywhere.
inline float lobeDensity(float width, float t) {
    const float reach = t + width;
    return width * (1 + width) / (4 * kPi * reach * reach);
}
// Draws a direction about the z axis with lobeDensity(). `choice` and `turn` are uniform in [0, 1).
inline vec3 drawLobe(float width, float choice, float turn) {
    return onCone(1 - 2 * choice * width / (1 + width - choice), turn);
}

// Draws a direction from the cosine or, with equal probability, from one of the lobes; it may be below the
// horizon. reflectedDensity() returns the density, in sr⁻¹.
vec3 drawReflected(vec3 mirror, HashedNumbers& random);
float reflectedDensity(vec3 mirror, vec3 incoming);

} // namespace relume

// Options of a bake that one word asks for.
#pragma once

#include "precompute/bake/bake_options.h"

namespace relume {

enum class BakePreset {
    Default,
    // The method of All-Frequency Relighting of Non-Diffuse Objects using Separable BRDF Approximation
    // (2004): visibility drawn from a simplified occluder, the BRDF at every visibility texel, eigenpairs of
    // orthographic tables, K = 4, rows of 96 coefficients.
    Paper,
};
inline constexpr BakePreset kBakePresets[] = {BakePreset::Default, BakePreset::Paper};

BakeOptions presetOptions(BakePreset preset);

// "default" and "paper".
std::string_view presetName(BakePreset preset);

// Returns the preset that has these options, or nothing if none has. What came of refinement does not count,
// nor that none is recorded where nothing was coarse.
std::optional<BakePreset> presetOf(const BakeOptions& options);

} // namespace relume

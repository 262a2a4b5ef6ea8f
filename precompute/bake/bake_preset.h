// Options of a bake that one word asks for.
#pragma once

#include "precompute/bake/bake_options.h"

namespace relume {

enum class BakePreset {
    Default,
    // As All-Frequency Relighting of Non-Diffuse Objects using Separable BRDF Approximation (2004) has it:
    // visibility drawn from a simplified occluder, the BRDF at every visibility texel, eigenpairs of
    // orthographic tables, K = 4, rows of 96 coefficients.
    Paper,
};

BakeOptions presetOptions(BakePreset preset);

// "default" and "paper".
std::string_view presetName(BakePreset preset);
std::optional<BakePreset> presetFromName(std::string_view name);

// The preset that these are the options of; none if any differs but what came of refinement, which is not
// recorded where nothing was coarse.
std::optional<BakePreset> presetOf(const BakeOptions& options);

} // namespace relume

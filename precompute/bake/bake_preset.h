// Named sets of bake options.
#pragma once

#include "precompute/bake/bake_options.h"

namespace relume {

enum class BakePreset {
    Default,
    // The method of the paper (All-Frequency Relighting of Non-Diffuse Objects using Separable BRDF
    // Approximation, 2004): visibility rasterized from a simplified occluder, the BRDF evaluated at every
    // visibility texel, eigenpairs of orthographic tables, K = 4, rows of 96 coefficients.
    Paper,
};
inline constexpr BakePreset kBakePresets[] = {BakePreset::Default, BakePreset::Paper};

BakeOptions presetOptions(BakePreset preset);

// Returns "default" or "paper".
std::string_view presetName(BakePreset preset);

// Returns the preset that has these options, or nothing if none has. Ignores the results of refinement, and
// whether refinement was dropped because no mesh was coarse.
std::optional<BakePreset> presetOf(const BakeOptions& options);

} // namespace relume

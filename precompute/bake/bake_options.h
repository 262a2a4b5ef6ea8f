// The options that determine the bytes of a bake.
#pragma once

#include "precompute/brdf/factorization.h"
#include "precompute/layout/layout_options.h"
#include "precompute/refine/refinement_record.h"
#include "precompute/visibility/visibility.h"

#include <cstddef>
#include <optional>

namespace relume {

// Returns the default N: 96 for rows, as in the paper; 384 for layouts that are encoded from rows.
int defaultCoefficients(TransportLayout layout);

struct BakeOptions {
    LayoutOptions layout;
    // K is an upper bound, 1 to 32: a diffuse material needs one term.
    FactorizationOptions factorization{.method = Factorization::NonNegative};
    int coefficients = defaultCoefficients(TransportLayout::Bases); // N, 1 to 6 F²
    int mapSize = 48;                                               // S, 4 to 64
    DiskMapping mapping = DiskMapping::EqualArea;
    int faceSize = 64;        // F: 32 or 64
    int visibilitySize = 256; // 64, 128 or 256
    VisibilityMethod visibilityMethod = VisibilityMethod::Traced;
    int transportSamples = 1; // light-map evaluations per lighting texel: 1, 4 or 16
    // Reflections between surfaces before the last one towards the eye, 0 (direct light only) to
    // kMostBounces.
    int bounces = 0;
    // Leave bounces out where materials of a set share terms (docs/bounces.md). Not recorded: an asset
    // records the bounces that it has.
    bool areBouncesAuto = false;
    // Triangle count to which the occluder is simplified; 0: keep all.
    size_t occluderTriangles = 0;
    // Store visibility in the file, for rebakes (KeptVisibility). Assets baked in memory never keep it.
    bool keepVisibility = false;
    // None: meshes stay as they are. Before a bake this holds the wanted error, in an asset also the result.
    std::optional<RefinementRecord> refinement = std::nullopt;

    // Returns the largest valid transportSamples: the number of visibility texels per lighting texel.
    int mostTransportSamples() const;
    // Throws UsageError naming the option, its valid values and what was given.
    void validate() const;
};

// Named sets of bake options.
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

// Every choice that decides a bake's bytes.
#pragma once

#include "precompute/brdf/factorization.h"
#include "precompute/layout/layout_options.h"
#include "precompute/refine/refinement_record.h"
#include "precompute/visibility/visibility.h"

#include <cstddef>
#include <optional>

namespace relume {

// N where none is named: what rows of the paper have; what others are made from may be as good as it can.
int defaultCoefficients(TransportLayout layout);

// Returns the default: the best pictures with the residual, for their bytes and time (docs/residual.md).
FactorizationOptions defaultFactorization();

struct BakeOptions {
    LayoutOptions layout;
    // K, 1 to 32, and how they are found. At most so many: a diffuse part needs a single one.
    FactorizationOptions factorization = defaultFactorization();
    int coefficients = defaultCoefficients(TransportLayout::Bases); // N, 1 to 6 F²
    int mapSize = 48;                                               // S, 4 to 64
    DiskMapping mapping = DiskMapping::EqualArea;
    int faceSize = 64;        // F: 32 or 64
    int visibilitySize = 256; // 64, 128 or 256
    // None: the faster one on the device, measured: see fasterVisibility().
    std::optional<VisibilityMethod> visibilityMethod = VisibilityMethod::Traced;
    int transportSamples = 1; // 1, 4 or 16 light-map evaluations per lighting texel
    // Reflections between surfaces, besides the last towards the eye: 0, direct light alone, to kMostBounces.
    int bounces = 0;
    // The plan leaves bounces out where several materials share terms in a set (docs/bounces.md). This is not
    // recorded: an asset's bounces are those that it has.
    bool areBouncesAuto = false;
    // Triangles that cast shadows, 0: all; the rest are simplified away.
    size_t occluderTriangles = 0;
    // Whether a file keeps the visibility it was made from: KeptVisibility. An asset in memory does not.
    bool keepVisibility = false;
    // None: meshes stay as they are. A bake's options hold what is wanted, an asset's what came of it as
    // well.
    std::optional<RefinementRecord> refinement = std::nullopt;

    // Returns the most transportSamples: the visibility texels in a lighting texel.
    int mostTransportSamples() const;
    // Throws UsageError naming the option, its valid values and what was given.
    void validate() const;
};

} // namespace relume

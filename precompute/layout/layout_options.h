// Options for how transport is stored and what it may cost.
#pragma once

#include "engine/transport/transport.h"

#include <optional>

namespace relume {

// At this error, clusters of bases meet without a visible seam under a sun. At 0.058, where they relight
// about as accurately as rows of 96 entries, their borders are visible.
constexpr double kDefaultLayoutError = 0.05;
// The default where all sets have one term, that is, all is diffuse: no highlight masks errors in shadows,
// and transport is small. Lower errors do not improve a bunny's shadow of a lamp any further
// (docs/layouts.md).
constexpr double kDiffuseLayoutError = 0.0125;

constexpr double kMostLayoutBytes = 1e6; // largest budget, per vertex
constexpr double kLeastLayoutError = 1e-6;

struct LayoutOptions {
    TransportLayout layout = TransportLayout::Bases;
    // Budget of bases: bytes of transport in memory per vertex of the asset. None: `error` decides.
    std::optional<double> bytesPerVertex;
    // Error that bases may have: RMS over transport, weighted by the mean spectrum of light, relative to each
    // set's normalization (transportNorm() in norm_sum.h). None: defaultLayoutError() of the asset.
    std::optional<double> error;

    bool operator==(const LayoutOptions&) const = default;
};

} // namespace relume

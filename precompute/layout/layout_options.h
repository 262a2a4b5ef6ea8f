// How transport is kept, and what it may cost.
#pragma once

#include "engine/transport/transport.h"

#include <optional>

namespace relume {

// Clusters of bases meet without a visible seam under a sun at this error. At 0.058, where they relight about
// as well as rows of 96 coefficients do, their borders are seen.
constexpr double kDefaultLayoutError = 0.05;
// The same where all sets have one term, that is, where all is diffuse: no highlight hides what storage loses
// of shadows, and they take few bytes. Beyond it a bunny's shadow of a lamp gains nothing (docs/layouts.md).
constexpr double kDiffuseLayoutError = 0.0125;

constexpr double kMostLayoutBytes = 1e6; // per vertex, that may be asked for

struct LayoutOptions {
    TransportLayout layout = TransportLayout::Bases;
    // The budget of bases: bytes of transport in memory per vertex of the asset. None: `error` decides.
    std::optional<double> bytesPerVertex;
    // The error of transport that bases may have, weighted as light weighs it: root mean square, relative to
    // each set's variation (transportUnit() in unit_sum.h). None: standardError() of the asset.
    std::optional<double> error;

    bool operator==(const LayoutOptions&) const = default;
};

} // namespace relume

// Measures size, error and baking time of bases from a sample of blocks.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/bake/block_baker.h"
#include "precompute/error/error_grid.h"

#include <functional>

namespace relume {

// The values of LayoutOptions::error that are tried, descending.
constexpr std::array<double, 7> kTriedLayoutErrors = {0.4, 0.25, 0.15, 0.1, 0.05, 0.03, 0.015};

struct LayoutCosts {
    // By tried error: RMS difference in radiance between bases and the rows that they are made from,
    // relative to the exact radiance, of sums of terms under the whole light, without a residual; and bytes
    // of the whole asset's transport in memory.
    std::array<double, kTriedLayoutErrors.size()> errors{}, bytes{};
    double bakeSeconds = 0; // for all vertices, extrapolated from the sample
};

// Bakes a few blocks of every part on the device and encodes them in bases, the layout that `plan` must have.
// If the plan has bounces, computes them first and leaves them in `plan`. Parts are weighted by their share
// of the image, from `grid`; vertices are seen from those `eyes` that are in front of them. `progress`, not
// empty, is called with the share done, after a part's bake and after each of its layouts. Throws BakeStopped
// and Error.
LayoutCosts layoutCosts(const vk::Device& device, BakePlan& plan, const Appearance& appearance,
                        const LightVector& light, std::span<const vec3> eyes, const ErrorGrid& grid,
                        BakeObserver& observer, const std::function<void(double)>& progress);

} // namespace relume

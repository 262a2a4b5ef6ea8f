// What bases take and lose, and what baking takes, of a few blocks of a bake.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/bake/block_baker.h"
#include "precompute/error/error_grid.h"

#include <functional>

namespace relume {

// LayoutOptions::error that are tried, falling.
constexpr std::array<double, 7> kTriedLayoutErrors = {0.4, 0.25, 0.15, 0.1, 0.05, 0.03, 0.015};

struct LayoutCosts {
    // By tried error: the radiance that bases give against that of rows of plan.options.coefficients, root
    // mean square relative to the exact radiance; and bytes of the whole asset's transport in memory.
    std::array<double, kTriedLayoutErrors.size()> errors{}, bytes{};
    double bakeSeconds = 0; // of all vertices, as long as those of the sample took
};

// Bakes a few blocks of every part on the device and encodes them, after finding all bounced light where
// there is to be any, which `plan` keeps. `plan` is for bases. Vertices count as much as `grid` says of their
// part's share of images, seen from `eyes` in front of them. `progress`, not empty, is told the share that is
// done, after a part's bake and after each of its layouts. Throws BakeStopped, Error.
LayoutCosts layoutCosts(const vk::Device& device, BakePlan& plan, const Appearance& appearance,
                        const LightVector& light, std::span<const vec3> eyes, const ErrorGrid& grid,
                        BakeObserver& observer, const std::function<void(double)>& progress);

} // namespace relume

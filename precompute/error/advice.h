// The least that a bake must be for images of an error.
#pragma once

#include "engine/scene/scene.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/error/error_study.h"

namespace relume {

struct AdviceRequest {
    Scene scene;
    double error = 0; // wanted: root mean square over pixels, relative to that of the exact image
    // All that is not advised on: K, N and the layout with what it may lose.
    BakeOptions options;
    size_t points = 600; // that are looked at, over all views
};

// A bake that gives images of the error.
struct AdvisedBake {
    BakeOptions options; // K, N and layout are set
    double error = 0;    // predicted
    double bytes = 0;    // of transport in memory
    double seconds = 0;  // of the bake on this device, from a sample
};

struct Advice {
    uint64_t vertices = 0;
    // By K, from 1: the error with all coefficients and nothing quantised.
    std::vector<double> leastErrors;
    // In bases, and in rows; none where the error is not reached.
    std::optional<AdvisedBake> bases, rows;
};

// Looks at the object from four sides, default appearance. Takes a minute or so. Throws UsageError for
// Factorization::NonNegative, whose terms are only good together, and as planBake() and StageTracer do.
Advice advise(const vk::Device& device, const AdviceRequest& request, const StudiedLight& light,
              BakeObserver& observer, const std::function<void(double)>& progress = {});

} // namespace relume

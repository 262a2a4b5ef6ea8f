// Finds the smallest bake whose images have at most a given error.
#pragma once

#include "engine/import/scene.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/error/error_study.h"

namespace relume {

// The input of advise().
struct AdviceRequest {
    Scene scene;
    // The scene as a refining bake takes it; none: refinement is not considered.
    std::optional<Scene> refinable;
    double error = 0;         // wanted RMS error over pixels, relative to the RMS of the exact image
    BakeOptions options = {}; // all but what is advised: K, N, layout, layout error, refinement
    size_t points = 600;      // number of points sampled, over all views
};

// A bake that reaches the wanted error.
struct AdvisedBake {
    BakeOptions options; // with K, N, layout and refinement set
    double error = 0;    // predicted
    double bytes = 0;    // of transport in memory
    // Estimated time of the bake on this device, including refinement; none: unknown.
    std::optional<double> seconds;
};

// Advice for the meshes as given, or as refined.
struct MeshAdvice {
    uint64_t vertices = 0;
    std::vector<double> leastErrors; // by K, from 1: with all coefficients, unquantized
    // The rows of fewest bytes, and bases with the least K that leaves some of the error to the layout. None
    // if the wanted error cannot be reached.
    std::optional<AdvisedBake> bases, rows;
};

struct Advice {
    MeshAdvice plain;
    std::optional<MeshAdvice> refined;

    // Returns the bake of fewest bytes, in bases or rows; null if none reaches the error.
    const AdvisedBake* best() const;
    // Returns the advice that best() is part of; `plain` if there is none.
    const MeshAdvice& bestMesh() const;
};

// Samples the object from four sides in its default appearance, which takes minutes. Meshes of more than
// kMostRefinedVertices are not refined. Factorization::NonNegative's terms are only good together:
// Environment's are tried instead, with the residual (residual.h). Throws as planBake() and StageTracer do.
Advice advise(const vk::Device& device, AdviceRequest request, const StudiedLight& light,
              BakeObserver& observer, const std::function<void(double)>& progress = {});

} // namespace relume

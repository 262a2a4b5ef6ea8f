// The least that a bake must be for images of an error.
#pragma once

#include "engine/import/scene.h"
#include "engine/vk/device.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/error/error_study.h"

namespace relume {

struct AdviceRequest {
    Scene scene;
    // The same as a bake that refines takes it; none: refinement is not considered.
    std::optional<Scene> refinable;
    double error = 0;         // wanted: root mean square over pixels, relative to that of the exact image
    BakeOptions options = {}; // all that is not advised on: K, N, the layout, what it may lose, refinement
    size_t points = 600;      // that are looked at, over all views
};

// A bake that gives images of the error.
struct AdvisedBake {
    BakeOptions options; // K, N, layout and refinement are set
    double error = 0;    // predicted
    double bytes = 0;    // of transport in memory
    // Of the bake on this device, refinement included, from a sample; none: not known.
    std::optional<double> seconds;
};

// What can be had of meshes as they are, or as they are refined.
struct MeshAdvice {
    uint64_t vertices = 0;
    std::vector<double> leastErrors; // by K, from 1: with all coefficients and nothing quantized
    // Rows of the fewest bytes; bases of the least K that leaves them some of the error. None where the error
    // is not reached.
    std::optional<AdvisedBake> bases, rows;
};

struct Advice {
    MeshAdvice plain;
    std::optional<MeshAdvice> refined;

    // The bake in bases of fewest bytes, or in rows where there is none; null where nothing reaches the
    // error.
    const AdvisedBake* best() const;
    // The mesh that it is of; of the plain one where there is none.
    const MeshAdvice& bestMesh() const;
};

// Looks at the object from four sides, default appearance. Takes minutes. Meshes of more than
// kMostRefinedVertices are left as they are. Terms of Factorization::NonNegative are only good together:
// Environment's are tried in their place, with what they leave (residual.h). Throws as planBake() and
// StageTracer do.
Advice advise(const vk::Device& device, AdviceRequest request, const StudiedLight& light,
              BakeObserver& observer, const std::function<void(double)>& progress = {});

} // namespace relume

// An image's error, measured, and taken apart into its sources.
#pragma once

#include "engine/light/light.h"
#include "engine/light/light_selection.h"
#include "engine/vk/device.h"
#include "precompute/error/error_budget.h"
#include "precompute/error/view_points.h"
#include "precompute/reference/progressive_reference.h"

namespace relume {

struct ErrorView {
    Camera camera;
    int width = 120, height = 90; // every pixel that sees the asset is a point
};

struct StudiedLight {
    Light light;    // what is drawn under
    LightCube fine; // of kTruthFaceSize: the same, as finely as it is known
    LightSelection selection;
};

// Root mean squares relative to that of the truth.
struct ErrorStudy {
    std::vector<StageRadiance> stages; // per point
    ErrorBudget budget;
    Image drawn;     // by the device
    Image reference; // sampled (ProgressiveReference), linear
    int passes = 0;
    double measured = 0;   // drawn against the reference, free of the reference's noise
    double noise = 0;      // standard error of the reference
    double drawnAside = 0; // drawn against the first stage: what the twin of drawing misses
    double truthAside = 0; // the last stage against the reference, free of its noise
};

// Of one view under several lights, which share all rays. Reference passes are added until its noise is a
// tenth of the measured error, at most `mostPasses`. Throws Error. `progress` as StageTracer::trace().
struct ErrorStudyOptions {
    ErrorView view;
    int mostPasses = 512;
};
std::vector<ErrorStudy> studyErrors(const vk::Device& device, const Asset& asset,
                                    const Appearance& appearance, std::span<const StudiedLight> lights,
                                    const ErrorStudyOptions& options, ViewPoints& points,
                                    const std::function<void(double)>& progress = {});

} // namespace relume

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

// What low-order spherical harmonics would give.
struct LowOrderStudy {
    Image image;           // all else exact: the truth under lowOrderLight(); linear, clamped at zero
    double error = 0;      // of that
    double termsError = 0; // with the K terms of the bake, under lowOrderLight() of 6 F² texels
};

// Of one light. Root mean squares relative to that of the truth.
struct ErrorStudy {
    std::vector<StageRadiance> stages; // per point; the first are the pixels of `drawn`
    ErrorBudget budget;
    Image drawn;     // by the device
    Image reference; // sampled (ProgressiveReference), linear
    int passes = 0;
    double measured = 0;   // drawn against the reference, free of the reference's noise
    double noise = 0;      // standard error of the reference
    double truthAside = 0; // the last stage against the reference, free of its noise
    std::optional<LowOrderStudy> lowOrder;
};

struct ErrorStudies {
    ViewPoints points;
    std::vector<ErrorStudy> lights;
};

struct ErrorStudyOptions {
    ErrorView view;
    int mostPasses = 512; // of the reference, added until its noise is a tenth of the measured error; 0: none
    int lowOrder = 0;     // of LowOrderStudy; 0: none
    bool residual = true; // what K terms leave of BRDFs is added
    // Reflections between surfaces that the truth has, at least the asset's own; none: as many as the asset.
    std::optional<int> bounces = {};
};

// One view under several lights, which share all rays but those of paths. Throws Error. `progress` as
// StageTracer::trace().
ErrorStudies studyErrors(const vk::Device& device, const Asset& asset, const Appearance& appearance,
                         std::span<const StudiedLight> lights, const ErrorStudyOptions& options,
                         const std::function<void(double)>& progress = {});

} // namespace relume

// Measures the error of an image and breaks it down by source.
#pragma once

#include "engine/light/light.h"
#include "engine/light/light_selection.h"
#include "engine/vk/device.h"
#include "precompute/error/error_budget.h"
#include "precompute/error/view_points.h"
#include "precompute/reference/progressive_reference.h"

namespace relume {

// The camera and image size of a study.
struct ErrorView {
    Camera camera;
    int width = 120, height = 90; // every pixel that shows the asset is a point
};

struct StudiedLight {
    Light light;    // the light that images are drawn with
    LightCube fine; // of kTruthFaceSize: the same light at the finest resolution known
    LightSelection selection;
};

// The result if light and transport were projected onto low-order spherical harmonics.
struct LowOrderStudy {
    Image image;           // the truth under lowOrderLight(), all else exact; linear, clamped at zero
    double error = 0;      // RMS error of that image
    double termsError = 0; // with the K terms of the bake under lowOrderLight() of 6 F² texels
};

// The study of one light. Errors are RMS relative to the RMS of the truth.
struct ErrorStudy {
    std::vector<StageRadiance> stages; // per point, in the order of ViewPoints; [0] is the pixel in `drawn`
    ErrorBudget budget;
    Image drawn;           // drawn by the device
    Image reference;       // linear, from ProgressiveReference
    int passes = 0;        // of the reference
    double measured = 0;   // drawn against the reference, without the reference's noise
    double noise = 0;      // standard error of the reference
    double truthAside = 0; // last stage against the reference, without its noise
    std::optional<LowOrderStudy> lowOrder;
};

struct ErrorStudies {
    ViewPoints points;
    std::vector<ErrorStudy> lights;
};

struct ErrorStudyOptions {
    ErrorView view;
    int mostPasses = 512; // of the reference, ended once its noise is a tenth of the error; 0: none
    int lowOrder = 0;     // order of LowOrderStudy; 0: none
    bool residual = true; // draw with the residual
    // Reflections between surfaces in the truth, at least the asset's own; none: the asset's.
    std::optional<int> bounces = {};
};

// Throws UsageError for more pixels than a study can look at, as studyErrors() does.
void expectStudiedSize(int width, int height);

// Studies one view under several lights, which share all rays except those of paths. `progress` is as for
// StageTracer::trace(). Throws Error.
ErrorStudies studyErrors(const vk::Device& device, const Asset& asset, const Appearance& appearance,
                         std::span<const StudiedLight> lights, const ErrorStudyOptions& options,
                         const std::function<void(double)>& progress = {});

} // namespace relume

#include "precompute/error/error_study.h"

#include "engine/base/error.h"
#include "engine/render/view_pass.h"
#include "engine/transport/asset_check.h"
#include "precompute/error/low_order_light.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

// Draws an image per light on the device.
std::vector<Image> draw(const vk::Device& device, const Asset& asset, const Appearance& appearance,
                        std::span<const StudiedLight> lights, bool addsResidual, const ErrorView& look) {
    LightPass lightPass(device, asset.faceSize);
    Relighter relighter(device, asset, {.residual = addsResidual});
    ViewPass view(device, asset, {look.width, look.height, 1});
    view.setAppearance(appearance);
    std::vector<Image> images;
    for (const StudiedLight& studied : lights) {
        lightPass.setLight(studied.light);
        vk::Commands commands(device, "error study");
        commands.begin();
        lightPass.record(commands, 0, studied.selection);
        relighter.record(commands, lightPass, appearance);
        view.record(commands, look.camera, relighter);
        commands.submitAndWait();
        images.push_back(view.read());
    }
    return images;
}

// Adds passes until the noise is small relative to the error of `study.drawn`, and records the results.
void measure(ProgressiveReference& reference, const ViewPoints& points, int mostPasses,
             const std::function<void()>& afterPass, ErrorStudy& study) {
    constexpr int kFirstCheck = 16;
    constexpr double kEnough = 0.1;
    std::optional<ReferenceError> error;
    for (int next = kFirstCheck; reference.passes() < mostPasses; next *= 2) {
        while (reference.passes() < std::min(next, mostPasses)) {
            reference.addPass();
            afterPass();
        }
        error = reference.errorOf(study.drawn);
        if (!error || error->noise <= kEnough * error->rmse) break;
    }
    study.passes = reference.passes();
    study.reference = reference.mean();
    if (!error || error->level == 0) return;
    study.measured = error->rmse / error->level;
    study.noise = error->noise / error->level;
    const Image truth = points.image([&](size_t i) { return study.stages[i][kErrorSources]; });
    study.truthAside = reference.errorOf(truth)->rmse / error->level;
}

StageLight stageLight(const Light& light, const LightCube& fine, int faceSize,
                      const LightSelection& selection) {
    return {drawnLight(sampleLight(light, faceSize), selection), fine};
}

// Returns the light for stages from kTermsStage on; earlier ones are not used.
StageLight lowOrderStage(const StageLight& light, int order) {
    return {drawnLight(lowOrderLight(light.drawn[size_t(LightPart::Whole)].cube, order), {}),
            lowOrderLight(light.fine, order)};
}
constexpr size_t kTermsStage = size_t(ErrorSource::Interpolation) + 1; // K terms, all before them exact

// Returns the error of a stage against the truth in `exact`.
double errorOf(std::span<const StageRadiance> stages, size_t stage, std::span<const StageRadiance> exact,
               double level) {
    double sum = 0;
    for (size_t i = 0; i < stages.size(); i++) {
        const glm::dvec3 difference =
            glm::dvec3(glm::max(stages[i][stage], vec3(0))) - glm::dvec3(exact[i][kErrorSources]);
        sum += glm::dot(difference, difference);
    }
    return level > 0 ? std::sqrt(sum / (3 * double(stages.size()))) / level : 0;
}

LowOrderStudy studyLowOrder(const ViewPoints& points, std::span<const StageRadiance> low,
                            const ErrorStudy& study) {
    return {points.image([&](size_t i) { return glm::max(low[i][kErrorSources], vec3(0)); }),
            errorOf(low, kErrorSources, study.stages, study.budget.level),
            errorOf(low, kTermsStage, study.stages, study.budget.level)};
}

// Reports the recomputation of bounced light as a share of all work.
class BounceObserver : public BakeObserver {
  public:
    // Keeps a reference to `tell`, which may be empty.
    BounceObserver(const std::function<void(double)>& tell, double share, int bounces)
        : mTell(tell), mShare(share), mPasses(bounces + 1) {}

    void stage(BakeStage, const std::string& part) override { mPass += part.empty(); }
    void progress(const BakeStatus& status) override {
        if (mTell) mTell(mShare * std::min((mPass - 1 + status.fraction) / mPasses, 1.0));
    }

  private:
    const std::function<void(double)>& mTell;
    double mShare;
    int mPasses, mPass = 1; // direct transport, which names parts, then each bounce
};

} // namespace

void expectStudiedSize(int width, int height) {
    constexpr uint64_t kMostPixels = 1u << 18; // hours, since a pixel takes tens of milliseconds
    const uint64_t pixels = uint64_t(width) * uint64_t(height);
    if (pixels > kMostPixels)
        throw UsageError(
            fmt::format("--size: expected at most {} pixels, each of which is traced many thousand times; "
                        "found {}",
                        kMostPixels, pixels));
}

ErrorStudies studyErrors(const vk::Device& device, const Asset& asset, const Appearance& appearance,
                         std::span<const StudiedLight> lights, const ErrorStudyOptions& options,
                         const std::function<void(double)>& progress) {
    const int bounces = options.bounces.value_or(asset.bounces);
    if (bounces < asset.bounces || bounces > kMostBounces)
        throw UsageError(fmt::format("--bounces: expected {}, as many as the bake has, to {}, found {}",
                                     asset.bounces, kMostBounces, bounces));
    const ErrorView& view = options.view;
    expectStudiedSize(view.width, view.height);
    ErrorStudies studies{viewPoints(RayTracer(partMeshes(asset)), view.camera, view.width, view.height), {}};
    const ViewPoints& points = studies.points;
    if (points.hits.empty())
        throw UsageError(fmt::format("none of {} x {} pixels shows the asset: choose another view",
                                     view.width, view.height));
    const std::vector<Image> drawn = draw(device, asset, appearance, lights, options.residual, view);

    std::vector<StageLight> stageLights;
    for (const StudiedLight& studied : lights)
        stageLights.push_back(stageLight(studied.light, studied.fine, asset.faceSize, studied.selection));
    if (options.lowOrder > 0)
        for (size_t i = 0; i < lights.size(); i++)
            stageLights.push_back(lowOrderStage(stageLights[i], options.lowOrder));
    const double bouncesShare = asset.bounces > 0 ? 0.4 : 0; // of the work, roughly
    constexpr double kStagesShare = 0.85;                    // including that
    StageOptions stageOptions{options.residual, bounces};
    if (asset.bounces > 0) {
        BounceObserver observer(progress, bouncesShare, asset.bounces);
        stageOptions.bounced = bouncedTransportOf(device, asset, observer);
    }
    const auto stagesProgress = [&](double share) {
        if (progress) progress(bouncesShare + (kStagesShare - bouncesShare) * share);
    };
    std::vector<std::vector<StageRadiance>> stages =
        StageTracer(asset, appearance, stageOptions)
            .trace(points.hits, view.camera.eye, stageLights, stagesProgress);

    ProgressiveReference reference(asset, ReferenceBrdf::Exact, bounces);
    for (size_t i = 0; i < lights.size(); i++) {
        ErrorStudy& study = studies.lights.emplace_back();
        study.stages = std::move(stages[i]);
        study.drawn = drawn[i];
        for (size_t point = 0; point < points.pixels.size(); point++)
            study.stages[point][0] = vec3(study.drawn.pixels[points.pixels[point]]);
        study.budget = errorBudget(study.stages);
        reference.restart(view.camera, lights[i].fine, appearance, view.width, view.height, 1);
        const double done = kStagesShare + (1 - kStagesShare) * double(i) / double(lights.size());
        const auto afterPass = [&] {
            if (progress) progress(done);
        };
        if (options.mostPasses > 0) measure(reference, points, options.mostPasses, afterPass, study);
        if (options.lowOrder > 0) study.lowOrder = studyLowOrder(points, stages[lights.size() + i], study);
        if (study.budget.level == 0)
            throw Error("what is seen is black: under no light no error can be told");
    }
    if (progress) progress(1);
    return studies;
}

} // namespace relume

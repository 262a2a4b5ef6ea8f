#include "apps/relume/appearance_arguments.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/light/background.h"
#include "engine/transport/asset_check.h"
#include "precompute/reference/progressive_reference.h"
#include "precompute/reference/reference_image.h"

#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct ReferenceArguments {
    std::string file;
    CameraArguments camera;
    LightArguments light;
    ImageArguments image;
    AppearanceArguments appearance;
    std::string brdf = "exact", lightForm = "cube", occluder = "full";
    int rays = 4, environmentWidth = 1024, samples = kDefaultSamples, paths = 256;
    std::optional<int> bounces;  // none: as many as the bake has
    std::optional<double> noise; // none: sum over all of the light
};

// Side, in texels, of the light cube that stands for a full environment where light is sampled.
constexpr int kSampledFaceSize = 256;
constexpr int kFewestPasses = 16; // too few give no reliable estimate of the noise
constexpr int kMostPasses = 1 << 16;

// Renders by sampling, in passes, until the noise is small.
class Sampling {
  public:
    Sampling(double noise, const Asset& asset, const Camera& camera, const LightCube& light,
             const ReferenceOptions& options)
        : mNoise(noise), mReference(asset, options.brdf, options.bounces) {
        mReference.restart(camera, light,
                           options.appearance.empty() ? defaultAppearance(asset) : options.appearance,
                           options.width, options.height, options.samples, options.groundFade);
    }

    // Adds passes until the noise is small enough, or Ctrl-C. Calls `show` after 1, 2, 4, 8, … passes.
    void run(const std::function<void(const Image&)>& show) {
        catchInterrupts();
        Progress progress("tracing", kFewestPasses, "passes");
        int nextEstimate = kFewestPasses; // rarely, so that no lucky moment ends it
        while (caughtInterrupt() == 0 && mReference.passes() < kMostPasses) {
            mReference.addPass();
            const int passes = mReference.passes();
            if (passes == nextEstimate || passes == kMostPasses) {
                mReached = relativeNoise();
                nextEstimate = passes + passes / 4;
                // Noise falls with the square root of the number of passes.
                const double expected = passes * std::pow(*mReached / mNoise, 2);
                progress.setTotal(isDone()
                                      ? uint64_t(passes)
                                      : uint64_t(std::clamp<double>(expected, nextEstimate, kMostPasses)));
            }
            progress.update(uint64_t(passes));
            if (isDone()) return;
            if (std::has_single_bit(unsigned(passes))) show(mReference.mean());
        }
    }

    // Logs how many passes the image has, and its noise.
    void report() const {
        const std::string noise =
            mReached ? fmt::format("a noise of {:.2g} %", 100 * *mReached) : std::string("unknown noise");
        const std::string words = fmt::format("{} passes, with {}", mReference.passes(), noise);
        if (mReference.passes() == kMostPasses && !isDone())
            spdlog::warn("{}: these are the most; --noise asks for {:.2g} %", words, 100 * mNoise);
        else
            spdlog::info("{}", words);
    }

    Image image() const { return mReference.mean(); }

  private:
    bool isDone() const { return mReached && *mReached <= mNoise; }

    // Returns the standard error of the image, relative to its root mean square; or that of alpha, if it is
    // larger.
    double relativeNoise() const {
        const std::optional<ReferenceError> error = mReference.errorOf(mReference.mean());
        if (!error) return 0; // nothing is seen
        const double unlit = error->noise > 0 ? 1 : 0;
        return std::max(error->level > 0 ? error->noise / error->level : unlit, error->alphaNoise);
    }

    double mNoise;
    std::optional<double> mReached; // by the last estimate
    ProgressiveReference mReference;
};

void run(const ReferenceArguments& arguments) {
    arguments.image.check();
    CommandFiles files;
    files.addInput(arguments.file);
    arguments.light.addInputs(files);
    files.addOutput("--output", arguments.image.output);
    files.check();
    const Asset asset = readAsset(arguments.file);
    ReferenceOptions options;
    options.width = arguments.camera.width;
    options.height = arguments.camera.height;
    options.samples = arguments.samples;
    options.brdf = arguments.brdf == "factored"   ? ReferenceBrdf::Factored
                   : arguments.brdf == "residual" ? ReferenceBrdf::Residual
                                                  : ReferenceBrdf::Exact;
    if (arguments.noise && options.brdf == ReferenceBrdf::Residual)
        throw UsageError("--noise: light is sampled with --brdf exact or factored, found residual");
    if (arguments.noise && options.brdf != ReferenceBrdf::Exact && arguments.bounces.value_or(0) > 0)
        throw UsageError("--bounces: bounced light is traced with the exact BRDF alone; use --bounces 0");
    options.raysPerTexelSide = int(std::lround(std::sqrt(arguments.rays)));
    options.appearance = arguments.appearance.appearance(asset);
    options.bounces = arguments.bounces;
    options.paths = arguments.paths;
    options.groundFade = arguments.image.groundFade(asset);
    options.bakedOccluder = arguments.occluder == "baked";
    const Camera camera = arguments.camera.camera(asset);
    const float rotation = radians(arguments.light.rotationDegrees);

    const bool showsLight = arguments.image.showsLight(), isFull = arguments.lightForm == "environment";
    if (isFull && !arguments.light.isEnvironment())
        throw UsageError("--light-as environment: expected a single environment, found other light; use "
                         "--light-as cube");
    MovingLight moving = arguments.light.moving(showsLight);
    files.addInputs(moving.files());
    files.check();
    const Light light = moving.at(arguments.light.seconds);

    const Background background =
        showsLight ? makeBackground(light, arguments.image.backgroundBlur()) : Background();
    const auto write = [&](Image image, float exposure) {
        if (showsLight) drawBackground(image, background, camera, rotation);
        arguments.image.write(arguments.image.output, image, exposure);
    };
    if (arguments.noise) {
        const LightCube cube = isFull ? sampleEnvironment(prepareForSampling(arguments.light.environment(),
                                                                             arguments.environmentWidth),
                                                          kSampledFaceSize, rotation)
                                      : sampleLight(turned(light, rotation), asset.faceSize);
        Sampling sampling(*arguments.noise, asset, camera, cube, options);
        sampling.run([&](const Image& image) { write(image, arguments.image.exposureFor(image, false)); });
        const Image image = sampling.image();
        write(image, arguments.image.exposureFor(image));
        sampling.report();
        if (caughtInterrupt() != 0) {
            spdlog::warn("stopped; {} has the passes so far", arguments.image.output.string());
            throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
        }
        return;
    }
    Progress progress("tracing", uint64_t(options.height), "rows");
    const auto report = [&](int rows) { progress.update(uint64_t(rows)); };
    const Image image =
        isFull ? renderReference(asset, camera, arguments.light.environment(), rotation,
                                 arguments.environmentWidth, options, report)
               : renderReference(asset, camera, sampleLight(turned(light, rotation), asset.faceSize), options,
                                 report);
    write(image, arguments.image.exposureFor(image));
}

} // namespace

void addReferenceCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("reference", "Ray-trace the image that `render` should give, with Embree");
    const auto arguments = std::make_shared<ReferenceArguments>();
    command->add_option("FILE", arguments->file, "Bake (.relume)")->required();
    arguments->image.add(*command);
    arguments->appearance.add(*command);
    arguments->light.add(*command);
    arguments->camera.add(*command);
    addSamples(*command, arguments->samples);
    command
        ->add_option(
            "--brdf", arguments->brdf,
            "exact; factored: the baked K terms; residual: these, and what they leave without shadows")
        ->check(CLI::IsMember({"exact", "factored", "residual"}))
        ->capture_default_str();
    command
        ->add_option("--light-as", arguments->lightForm,
                     "cube: the bake's lighting texels; environment: the full map")
        ->check(CLI::IsMember({"cube", "environment"}))
        ->capture_default_str();
    command
        ->add_option("--occluder", arguments->occluder,
                     "What casts shadows: full mesh, or the baked occluder")
        ->check(CLI::IsMember({"full", "baked"}))
        ->capture_default_str();
    command->add_option("--rays", arguments->rays, "Shadow rays per lighting texel: 1, 4, 16 or 64")
        ->check(CLI::IsMember({1, 4, 16, 64}))
        ->capture_default_str();
    command
        ->add_option("--bounces", arguments->bounces,
                     "Reflections between surfaces before the last, traced with the exact BRDF: 0 to 8")
        ->check(CLI::Range(0, kMostBounces))
        ->type_name("B")
        ->default_str("the bake's own, with --brdf exact");
    command->add_option("--paths", arguments->paths, "Paths per pixel that find bounced light")
        ->check(CLI::Range(1, 1 << 20))
        ->type_name("COUNT")
        ->capture_default_str();
    command
        ->add_option(
            "--noise", arguments->noise,
            "Sample light in passes until the noise is at most this share of the image: 0.05 is a preview, "
            "0.005 clean. The image is written as it improves, and kept on Ctrl-C")
        ->check(between(1e-4f, 1))
        ->type_name("SHARE")
        ->default_str("no sampling: all light is summed")
        ->excludes(command->get_option("--rays"))
        ->excludes(command->get_option("--paths"))
        ->excludes(command->get_option("--occluder"));
    command->add_option("--environment-width", arguments->environmentWidth, "Most columns of the full map")
        ->check(CLI::Range(16, 16384))
        ->capture_default_str();
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

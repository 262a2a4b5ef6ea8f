#include "apps/relume/appearance_arguments.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/progress.h"
#include "engine/light/background.h"
#include "engine/transport/asset_check.h"
#include "precompute/reference/reference_image.h"

#include <cmath>

namespace relume {

namespace {

struct Arguments {
    std::string file;
    CameraArguments camera;
    LightArguments light;
    ImageArguments image;
    AppearanceArguments appearance;
    std::string brdf = "exact", lightForm = "cube", occluder = "full";
    int rays = 4, environmentWidth = 1024, samples = kDefaultSamples, paths = 256;
    std::optional<int> bounces; // none: as many as the bake has
};

void run(const Arguments& arguments) {
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

    Progress progress("tracing", uint64_t(options.height), "rows");
    const auto report = [&](int rows) { progress.update(uint64_t(rows)); };
    Image image = isFull
                      ? renderReference(asset, camera, arguments.light.environment(), rotation,
                                        arguments.environmentWidth, options, report)
                      : renderReference(asset, camera, sampleLight(turned(light, rotation), asset.faceSize),
                                        options, report);
    const float exposure = arguments.image.exposureFor(image);
    if (showsLight)
        drawBackground(image, makeBackground(light, arguments.image.backgroundBlur()), camera, rotation);
    arguments.image.write(arguments.image.output, image, exposure);
}

} // namespace

void addReferenceCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("reference", "Ray-trace the image that `render` should give, with Embree");
    const auto arguments = std::make_shared<Arguments>();
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
    command->add_option("--environment-width", arguments->environmentWidth, "Most columns of the full map")
        ->check(CLI::Range(16, 16384))
        ->capture_default_str();
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

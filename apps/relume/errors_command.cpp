#include "apps/relume/appearance_arguments.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/studied_light.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/progress.h"
#include "engine/import/image_file.h"
#include "precompute/error/heat_maps.h"
#include "precompute/error/study_json.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

struct ErrorsArguments {
    std::string file;
    CameraArguments camera;
    StudiedLightArguments light;
    AppearanceArguments appearance;
    DeviceArguments device;
    std::filesystem::path images; // folder; empty for none
    bool residual = true;
    std::optional<int> bounces; // none: as many as the bake has
    bool json = false;
};

constexpr int kLowOrder = 5; // 25 coefficients, as most engines keep

void writeImages(const std::filesystem::path& folder, const ErrorStudy& study, const ViewPoints& points) {
    constexpr int kScale = 4;
    writeExr(folder / "drawn.exr", study.drawn);
    writeExr(folder / "reference.exr", study.reference);
    writeExr(folder / "harmonics.exr", study.lowOrder->image);
    for (const HeatMap& heat : heatMaps(study, points, kScale))
        writePng(folder / (heat.name + ".png"), heat.map);
}

// Adds the files that writeImages() writes.
void addImages(const std::filesystem::path& folder, CommandFiles& files) {
    std::vector<std::string> names = {"drawn.exr", "reference.exr", "harmonics.exr", "total.png"};
    for (size_t i = 0; i < kErrorSources; i++)
        names.push_back(std::string(errorSourceName(ErrorSource(i))) + ".png");
    for (const std::string& name : names) files.addOutput("--images", folder / name);
}

void print(const ErrorStudy& study) {
    fmt::print("source                         error     share of the total, squared\n");
    for (size_t i = 0; i < kErrorSources; i++)
        fmt::print("{:<28} {:>8.4f} {:>8.1f} %\n", errorSourceTitle(ErrorSource(i)),
                   study.budget.sources[i].rms, 100 * study.budget.sources[i].share);
    fmt::print("all of them                  {:>8.4f}   ± {:.4f}; {:.4f} were they independent\n",
               study.budget.total, study.budget.uncertainty, study.budget.rootSumSquares);
    fmt::print("measured                     {:>8.4f}   against a reference with noise {:.4f} ({} passes)\n",
               study.measured, study.noise, study.passes);
    fmt::print("not accounted for            {:>8.4f}   of the reference\n", study.truthAside);
    fmt::print("{} spherical harmonics       {:>8.4f}   instead, all else exact; {:.4f} with these K terms\n",
               kLowOrder * kLowOrder, study.lowOrder->error, study.lowOrder->termsError);
}

void run(const ErrorsArguments& arguments) {
    expectStudiedSize(arguments.camera.width, arguments.camera.height);
    CommandFiles files;
    const Asset asset = readAsset(arguments.file);
    if (asset.provenance.bakedShare)
        throw Error(fmt::format(
            "{}: is a preview, whose rows are interpolated for the most part; wait for the bake to end",
            arguments.file));
    const Appearance appearance = arguments.appearance.appearance(asset);
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    const StudiedLight light = arguments.light.studied();
    if (!arguments.images.empty()) addImages(arguments.images, files);
    files.check();
    if (!arguments.images.empty()) {
        std::error_code failure;
        std::filesystem::create_directories(arguments.images, failure); // the next line reports a failure
        expectWritable(arguments.images / "drawn.exr");
    }
    const ErrorView view{arguments.camera.camera(asset), arguments.camera.width, arguments.camera.height};
    const auto pixels = uint64_t(view.width) * uint64_t(view.height);
    Progress progress("tracing", pixels, "pixels");
    const ErrorStudies studies = studyErrors(
        *device, asset, appearance, std::span(&light, 1),
        {.view = view, .lowOrder = kLowOrder, .residual = arguments.residual, .bounces = arguments.bounces},
        [&](double share) { progress.update(uint64_t(double(pixels) * share)); });
    const ErrorStudy& study = studies.lights.front();
    if (!arguments.images.empty()) writeImages(arguments.images, study, studies.points);
    if (arguments.json)
        fmt::print("{}\n", describe(study, studies.points, asset).dump(2));
    else
        print(study);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addErrorsCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("errors", "Take an image's error apart: what every approximation costs");
    const auto arguments = std::make_shared<ErrorsArguments>();
    arguments->camera.width = 120, arguments->camera.height = 90;
    command->add_option("FILE", arguments->file, "Bake (.relume)")->required();
    arguments->appearance.add(*command);
    arguments->light.add(*command);
    arguments->camera.add(*command);
    arguments->device.add(*command);
    command
        ->add_option("--residual", arguments->residual,
                     "Draw with what the K terms leave of the BRDF; off: with the terms alone")
        ->check(CLI::IsMember({"on", "off"}))
        ->default_str("on");
    command
        ->add_option("--bounces", arguments->bounces,
                     "Reflections between surfaces that the exact image has, at least the bake's, up to 8")
        ->type_name("B")
        ->default_str("the bake's");
    command
        ->add_option("--images", arguments->images,
                     "Also write the images and a heat map of every source into this folder")
        ->type_name("FOLDER");
    command->add_flag("--json", arguments->json, "Data on stdout instead of a table");
    command->footer("Errors are root mean squares over pixels, relative to that of the exact image.\n"
                    "docs/errors.md explains every source.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/progress.h"
#include "engine/import/image_file.h"
#include "engine/render/contact_sheet.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct SheetArguments {
    std::vector<std::string> files, lights;
    std::filesystem::path output;
    CameraArguments camera;
    DeviceArguments device;
    std::string tone = "agx";
    int samples = kDefaultSamples;
};

void checkFiles(const SheetArguments& arguments) {
    if (arguments.output.extension() != ".png")
        throw UsageError(
            fmt::format("--output: expected a name ending in .png, found {}", arguments.output.string()));
    CommandFiles files;
    for (const std::string& file : arguments.files) files.addInput(file);
    for (const std::string& light : arguments.lights) files.addInput(light);
    files.addOutput("--output", arguments.output);
    files.check();
    expectWritable(arguments.output);
}

void run(const SheetArguments& arguments) {
    checkFiles(arguments);
    std::vector<SheetColumn> columns;
    for (const std::string& file : arguments.lights) columns.push_back({stillLight(file, true)});
    std::vector<Asset> assets;
    std::vector<std::vector<SheetRow>> rows; // per bake
    size_t rowCount = 0;
    for (const std::string& file : arguments.files) {
        assets.push_back(readAsset(file));
        rows.push_back(sheetRows(assets.back(), std::filesystem::path(file).stem().string()));
        rowCount += rows.back().size();
    }
    ContactSheet sheet(std::move(columns), rowCount,
                       {arguments.camera.width, arguments.camera.height, arguments.samples,
                        *toneCurveFromName(arguments.tone)});
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    Progress progress("drawing", rowCount * arguments.lights.size(), "pictures");
    uint64_t drawn = 0;
    for (size_t file = 0; file < assets.size(); file++) {
        const int samples =
            sheet.add(*device, assets[file], rows[file], arguments.camera.camera(assets[file]),
                      [&] { progress.update(++drawn); });
        if (file == 0) tellSamples(samples, arguments.samples, *device);
    }
    writePng(arguments.output, sheet.image());
    size_t number = 0;
    for (const std::vector<SheetRow>& ofBake : rows)
        for (const SheetRow& row : ofBake) spdlog::info("row {}: {}", ++number, row.name);
    for (size_t column = 0; column < arguments.lights.size(); column++)
        spdlog::info("column {}: {}", column + 1,
                     arguments.lights[column].empty() ? "the built-in sky" : arguments.lights[column]);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addSheetCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("sheet", "Draw a contact sheet: every material of bakes under several lights");
    const auto arguments = std::make_shared<SheetArguments>();
    arguments->lights = {""};
    arguments->camera.width = 320, arguments->camera.height = 240;
    command->add_option("FILE", arguments->files, "Bakes (.relume): a row for each material of each")
        ->required();
    command
        ->add_option("-e,--environment", arguments->lights,
                     "A light for each column: latlong or cube .exr, .hdr, or a light file (.json); repeat "
                     "it for more (default: a built-in sky)")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command->add_option("-o,--output", arguments->output, "Image to write (.png)")
        ->type_name("IMAGE")
        ->required();
    arguments->camera.add(*command);
    addSamples(*command, arguments->samples);
    command->add_option("--tone", arguments->tone, "Tone curve")
        ->check(CLI::IsMember({"none", "aces", "agx"}))
        ->capture_default_str();
    arguments->device.add(*command);
    command->footer("Each column is exposed for its first row; --size is that of one picture.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

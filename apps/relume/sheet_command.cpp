#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/progress.h"
#include "engine/import/image_file.h"
#include "engine/render/background_pass.h"
#include "engine/render/ground_fade.h"
#include "engine/render/relighter.h"
#include "engine/render/tone_map.h"
#include "engine/render/view_pass.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct Arguments {
    std::vector<std::string> files, lights;
    std::filesystem::path output;
    CameraArguments camera;
    DeviceArguments device;
    std::string tone = "agx";
    int samples = kDefaultSamples;
};

// A row of the sheet: a bake and its appearance.
struct Row {
    size_t file;
    std::string name;
    Appearance appearance;
};

// Adds the bake as it is, then with each material that changes it.
void addRows(const Asset& asset, size_t file, const std::string& name, std::vector<Row>& rows) {
    const Appearance first = defaultAppearance(asset);
    rows.push_back({file, name, first});
    for (const std::string& material : materialNames(asset)) {
        Appearance appearance = first;
        bindMaterials(appearance, asset, std::vector<WeightedMaterial>{{material}});
        if (appearance != first) rows.push_back({file, fmt::format("{}, {}", name, material), appearance});
    }
}

// Draws the rows of one bake.
class SheetPass {
  public:
    SheetPass(const vk::Device& device, const Asset& asset, const Arguments& arguments)
        : mDevice(device), mLight(device, asset.faceSize), mRelighter(device, asset),
          mView(device, asset,
                {.width = arguments.camera.width,
                 .height = arguments.camera.height,
                 .samples = arguments.samples}),
          mBackground(device), mCamera(arguments.camera.camera(asset)) {
        mView.setGroundFade(makeGroundFade(asset, GroundStyle::Shadow));
    }

    // Draws a picture. `exposure` is in stops; if empty, it is set to suit the object.
    Image draw(const Light& light, const Appearance& appearance, std::optional<float>& exposure,
               ToneCurve tone) {
        mLight.setLight(light);
        mBackground.setLight(light);
        mView.setAppearance(appearance);
        vk::Commands commands(mDevice, "sheet");
        commands.begin();
        mLight.record(commands);
        mRelighter.record(commands, mLight, appearance);
        mView.record(commands, mCamera, mRelighter);
        mBackground.record(commands, mView.image(), mCamera);
        commands.submitAndWait();
        if (!exposure) exposure = autoExposure(mView.read());
        return toneMap(mBackground.read(), tone, *exposure);
    }

    int samples() const { return mView.samples(); }

  private:
    const vk::Device& mDevice;
    LightPass mLight;
    Relighter mRelighter;
    ViewPass mView;
    BackgroundPass mBackground;
    Camera mCamera;
};

void checkFiles(const Arguments& arguments) {
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

void run(const Arguments& arguments) {
    checkFiles(arguments);
    std::vector<Light> lights;
    for (const std::string& file : arguments.lights) lights.push_back(stillLight(file, true));
    std::vector<Asset> assets;
    std::vector<Row> rows;
    for (const std::string& file : arguments.files) {
        assets.push_back(readAsset(file));
        addRows(assets.back(), assets.size() - 1, std::filesystem::path(file).stem().string(), rows);
    }
    constexpr int kGap = 4;
    constexpr size_t kMostPixels = size_t(1) << 26;
    const int width = arguments.camera.width, height = arguments.camera.height;
    const size_t wide = lights.size() * size_t(width + kGap), high = rows.size() * size_t(height + kGap);
    if (wide * high > kMostPixels)
        throw UsageError(
            fmt::format("a sheet of {} rows and {} columns has {} x {} pixels: expected at most {} in "
                        "all; lower --size",
                        rows.size(), lights.size(), wide, high, kMostPixels));
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    Image sheet(int(wide) - kGap, int(high) - kGap);
    std::ranges::fill(sheet.pixels, vec4(1));

    std::vector<std::optional<float>> exposures(lights.size()); // per column, from its first row
    Progress progress("drawing", rows.size() * lights.size(), "pictures");
    std::optional<SheetPass> pass;
    for (size_t row = 0; row < rows.size(); row++) {
        if (row == 0 || rows[row].file != rows[row - 1].file) {
            pass.reset();
            pass.emplace(*device, assets[rows[row].file], arguments);
            if (row == 0) tellSamples(pass->samples(), arguments.samples, *device);
        }
        for (size_t column = 0; column < lights.size(); column++) {
            const Image image = pass->draw(lights[column], rows[row].appearance, exposures[column],
                                           *toneCurveFromName(arguments.tone));
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++)
                    sheet.at(int(column) * (width + kGap) + x, int(row) * (height + kGap) + y) =
                        image.at(x, y);
            progress.update(row * lights.size() + column + 1);
        }
    }
    writePng(arguments.output, sheet);
    for (size_t row = 0; row < rows.size(); row++) spdlog::info("row {}: {}", row + 1, rows[row].name);
    for (size_t column = 0; column < lights.size(); column++)
        spdlog::info("column {}: {}", column + 1,
                     arguments.lights[column].empty() ? "the built-in sky" : arguments.lights[column]);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addSheetCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("sheet", "Draw a contact sheet: every material of bakes under several lights");
    const auto arguments = std::make_shared<Arguments>();
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

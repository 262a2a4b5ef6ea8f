#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/image_file.h"
#include "precompute/twins/verification.h"
#include "precompute/twins/visibility_comparison.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

struct VerifyArguments {
    std::string file;
    std::filesystem::path visibilityImage;
    LightArguments light;
    DeviceArguments device;
    int samples = 200;
    bool json = false;
};

void run(const VerifyArguments& arguments) {
    if (!arguments.visibilityImage.empty()) {
        expectExtension("--visibility-image", arguments.visibilityImage, ".png");
        expectWritable(arguments.visibilityImage);
    }
    CommandFiles files;
    arguments.light.addInputs(files);
    const Asset asset = readAsset(arguments.file);
    files.addOutput("--visibility-image", arguments.visibilityImage);
    files.check();
    if (!arguments.light.isEnvironment())
        throw UsageError("verify: expected a single environment, found other light");
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    const Verification found = verify(*device, asset, prepareForSampling(arguments.light.environment()),
                                      radians(arguments.light.rotationDegrees), arguments.samples);
    const std::optional<VisibilityComparison> ways = compareVisibility(*device, asset, arguments.samples);
    if (!arguments.visibilityImage.empty() && !ways)
        throw Error(fmt::format("--visibility-image: {} cannot trace, so that there is nothing to compare",
                                device->name()));
    if (!arguments.visibilityImage.empty()) writePng(arguments.visibilityImage, ways->picture);
    if (arguments.json) {
        const Json json = {{"samples", found.samples},
                           {"visibility_mismatch", found.visibilityMismatch},
                           {"raster_traced_difference", ways ? Json(ways->share()) : Json()},
                           {"raster_traced_inside", ways ? Json(ways->inside) : Json()},
                           {"transport_error", found.transportError},
                           {"bounce_error", asset.bounces > 0 ? Json(found.bounceError) : Json()},
                           {"layout_error", found.layoutError},
                           {"wavelet_error", found.rows ? Json(found.rows->wavelet) : Json()},
                           {"quantization_error", found.rows ? Json(found.rows->quantization) : Json()},
                           {"brdf_error", found.brdfError},
                           {"relight_bits", found.relightBits},
                           {"total_error", found.totalError}};
        fmt::print("{}\n", json.dump(2));
    } else {
        fmt::print("vertices sampled     {}\n", found.samples);
        fmt::print("visibility mismatch  {:.6f}  of the texels above the horizon, against Embree\n",
                   found.visibilityMismatch);
        if (ways)
            fmt::print("raster and traced    {:.6f}  of them differ, {} where traced sees no silhouette\n",
                       ways->share(), ways->inside);
        fmt::print("transport error      {:.2e}  before compression, device against CPU\n",
                   found.transportError);
        if (asset.bounces > 0)
            fmt::print("bounce error         {:.4f}    light by way of other surfaces, against its twin\n",
                       found.bounceError);
        fmt::print("layout error         {:.4f}    all that is lost by how transport is kept\n",
                   found.layoutError);
        if (found.rows) {
            fmt::print("wavelet error        {:.4f}    lost by keeping {} coefficients\n",
                       found.rows->wavelet, asset.coefficients);
            fmt::print("quantization error   {:.5f}   of the coefficients kept\n", found.rows->quantization);
        }
        fmt::print("BRDF error           {:.4f}    cos-weighted RMS of the terms\n", found.brdfError);
        fmt::print("relight bits         {}         vertices that differ between device and CPU\n",
                   found.relightBits);
        fmt::print(
            "total error          {:.4f}    stored transport against uncompressed, Embree's visibility\n",
            found.totalError);
    }
    DeviceArguments::expectNoMessages(*device);
    if (found.relightBits > 0)
        throw Error(fmt::format("{} vertices relight differently on device and CPU", found.relightBits));
}

} // namespace

void addVerifyCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("verify", "Hold a bake against the CPU and Embree, stage by stage");
    const auto arguments = std::make_shared<VerifyArguments>();
    command->add_option("FILE", arguments->file, "Bake (.relume)")->required();
    command->add_option("--samples", arguments->samples, "Vertices to recompute")
        ->type_name("COUNT")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    command
        ->add_option("--visibility-image", arguments->visibilityImage,
                     "Draw the visibility of the vertex on which raster and traced differ most (.png)")
        ->type_name("IMAGE");
    arguments->light.add(*command);
    arguments->device.add(*command);
    command->add_flag("--json", arguments->json, "Print JSON");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

#include "apps/bench/timing.h"
#include "apps/bench/view_bench.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

struct BenchViewArguments {
    std::vector<std::string> files;
    CameraArguments camera;
    LightArguments light;
    DeviceArguments device;
    LightSelection selection;
    bool residual = true;
    std::vector<int> samples = {1};
    int repeats = 15;
    bool json = false;
};

Json medians(const std::map<std::string, std::vector<double>>& passes) {
    Json result = Json::object();
    for (const auto& [name, values] : passes) result[name] = median(values);
    return result;
}

Json describe(const std::string& file, const Asset& asset, int samples, const ViewSeries& series) {
    size_t triangles = 0;
    Json parts = Json::array();
    for (const AssetPart& part : asset.parts) {
        triangles += part.mesh.triangleCount();
        parts.push_back({{"name", part.name},
                         {"vertices", part.mesh.vertexCount()},
                         {"terms", part.sets[0].brdf.terms},
                         {"layout", layoutName(layoutOf(part.sets[0].transport))}});
    }
    const double viewMs = median(series.viewMs), lightMs = median(series.lightMs);
    return {{"file", file},
            {"vertices", vertexCount(asset)},
            {"triangles", triangles},
            {"parts", parts},
            {"samples", samples},
            {"covered_pixels", median(series.coveredPixels)},
            {"light_coefficients", median(series.lightCoefficients)},
            {"view_ms", viewMs},
            {"view_fps", 1e3 / viewMs},
            {"view_passes_ms", medians(series.viewPasses)},
            {"light_ms", lightMs},
            {"light_fps", 1e3 / lightMs},
            {"light_passes_ms", medians(series.lightPasses)}};
}

std::string termsOfParts(const Json& file) {
    std::vector<int> terms;
    for (const Json& part : file["parts"]) terms.push_back(part["terms"].get<int>());
    return fmt::format("{}", fmt::join(terms, "+"));
}

void printBenchView(const Json& result) {
    fmt::print("{}, {} x {} pixels\n\n", result["device"].get<std::string>(), result["width"].dump(),
               result["height"].dump());
    fmt::print("{:>6}{:>10}{:>10}{:>8}{:>10}{:>10}{:>7}{:>12}{:>11}{:>7}\n", "K", "vertices", "triangles",
               "samples", "covered", "view, ms", "fps", "on device", "light, ms", "fps");
    const auto number = [](const Json& value) { return value.get<double>(); };
    for (const Json& file : result["files"]) {
        const Json& passes = file["view_passes_ms"];
        fmt::print("{:>6}{:>10}{:>10}{:>8}{:10.0f}{:10.2f}{:7.1f}{:>12}{:11.2f}{:7.1f}  {}\n",
                   termsOfParts(file), file["vertices"].dump(), file["triangles"].dump(),
                   file["samples"].dump(), number(file["covered_pixels"]), number(file["view_ms"]),
                   number(file["view_fps"]),
                   passes.contains("view") ? fmt::format("{:.2f}", number(passes["view"])) : "",
                   number(file["light_ms"]), number(file["light_fps"]), file["file"].get<std::string>());
    }
    for (const Json& file : result["files"]) {
        fmt::print("\n{}, {} samples: a change of light\n", file["file"].get<std::string>(),
                   file["samples"].dump());
        for (const auto& [name, ms] : file["light_passes_ms"].items())
            fmt::print("  {:20}{:8.2f} ms\n", name, number(ms));
    }
}

void run(const BenchViewArguments& arguments) {
    std::vector<Asset> assets;
    for (const std::string& file : arguments.files) assets.push_back(readAsset(file));
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    ViewRounds rounds;
    rounds.count = arguments.repeats;
    rounds.rotationDegrees = arguments.light.rotationDegrees;
    rounds.selection = arguments.selection;
    rounds.width = arguments.camera.width;
    rounds.height = arguments.camera.height;
    rounds.residual = arguments.residual;
    rounds.samples = arguments.samples;
    rounds.camera = [&](const Asset& asset, float turn) { return arguments.camera.camera(asset, turn); };
    const std::vector<ViewSeries> series =
        benchView(*device, assets, arguments.light.light(), rounds, arguments.json);
    Json files = Json::array();
    for (size_t i = 0; i < series.size(); i++) {
        const size_t asset = i / rounds.samples.size();
        files.push_back(describe(arguments.files[asset], assets[asset],
                                 rounds.samples[i % rounds.samples.size()], series[i]));
    }
    const Json result = {{"device", device->info().name},
                         {"driver", device->info().driver},
                         {"width", rounds.width},
                         {"height", rounds.height},
                         {"repeats", rounds.count},
                         {"residual", rounds.residual},
                         {"files", files}};
    if (arguments.json)
        fmt::print("{}\n", result.dump(2));
    else
        printBenchView(result);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addBenchViewCommand(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand("view", "Turn a camera about bakes, and the light over them");
    const auto arguments = std::make_shared<BenchViewArguments>();
    arguments->camera.width = 1280;
    arguments->camera.height = 720;
    command->add_option("FILE", arguments->files, "Bakes (.relume), drawn in alternation")->required();
    arguments->camera.add(*command);
    arguments->light.add(*command);
    command
        ->add_option("--threshold", arguments->selection.threshold,
                     "Drop light coefficients below this, where the largest is 32767")
        ->type_name("VALUE")
        ->check(CLI::Range(0, kLightMaximum))
        ->default_str(fmt::format("the {} largest are kept", kDefaultLightCount));
    command->add_option("--residual", arguments->residual, "Add what K terms leave of BRDFs")
        ->check(CLI::IsMember({"on", "off"}))
        ->default_str("on");
    command
        ->add_option("--samples", arguments->samples,
                     "Samples a pixel, 1 (as the viewer draws what moves), 2, 4 or 8; several (1,4): each in "
                     "alternation")
        ->delimiter(',')
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
    arguments->device.add(*command);
    command->add_option("--repeats", arguments->repeats, "Rounds to take the medians of; one turn in all")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer(
        "view: record, submit and wait for a view, the camera turned by a degree.\n"
        "light: the same of a light turned by a degree, relighting in full and the view under the\n"
        "same camera, in one submission.\n"
        "on device: the view pass between its two timestamps.");
    command->callback([arguments, &bench] {
        expectNoOptions(bench, "view");
        run(*arguments);
    });
}

} // namespace relume

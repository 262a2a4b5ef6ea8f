#include "apps/bench/timing.h"
#include "apps/relume/commands.h"
#include "apps/relume/copy_bandwidth.h"
#include "apps/relume/options.h"
#include "apps/relume/relight_bench.h"
#include "engine/base/error.h"
#include "engine/base/progress.h"
#include "precompute/layout/conversion.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <tbb/info.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

struct BenchRelightArguments {
    std::string file;
    LightArguments light;
    DeviceArguments device;
    LightSelection selection;
    int coefficients = 96;
    std::optional<double> budget;
    double error = kDefaultLayoutError;
    std::vector<int> counts = {16, 64, 256, 1024, 4096};
    int repeats = 9;
    bool json = false;
};

RelightBenchInput makeInput(const Asset& source, const BenchRelightArguments& arguments) {
    RelightBenchInput input{&source, {}};
    for (size_t i = 0; i < kLayoutFacts.size(); i++) {
        const auto layout = TransportLayout(i);
        LayoutOptions options;
        options.layout = layout;
        options.bytesPerVertex = arguments.budget;
        options.error = arguments.error;
        std::optional<int> coefficients;
        if (!isCompressed(layout)) coefficients = arguments.coefficients;
        Asset asset = source;
        Progress progress(fmt::format("converting to {}", layoutName(layout)), vertexCount(source),
                          "vertices", arguments.json);
        convertLayout(
            asset, options, [&](uint64_t done, uint64_t) { progress.update(done); }, coefficients);
        input.variants.emplace_back(layoutName(layout), std::move(asset));
    }
    return input;
}

Json describe(const Asset& asset, const LayoutSeries& own, const RelightSeries& series, double bandwidth) {
    uint64_t bytes = 0;
    for (const AssetPart& part : asset.parts) bytes += bytesOf(part.sets[0].transport);
    const double ms = median(own.deviceMs), touched = median(own.bytesTouched);
    const double floorMs = 1e3 * touched / bandwidth;
    Json msByCount = Json::object();
    for (const auto& [count, values] : own.msByCount) msByCount[fmt::format("{}", count)] = median(values);
    return {{"ms", ms},
            {"fps", 1e3 / ms},
            {"cpu_ms", median(own.cpuMs)},
            {"bytes_per_vertex", double(bytes) / double(vertexCount(asset))},
            {"bytes_touched", touched},
            {"floor_ms", floorMs},
            {"share_of_floor", floorMs / ms},
            {"ratio_to_rows", medianRatio(own.deviceMs, series.layouts.at("rows").deviceMs)},
            {"ratio_to_eigen_csr", medianRatio(own.deviceMs, series.csrMs)},
            {"relit_error", median(own.errors)},
            {"lamp_ms", median(own.lampMs)},
            {"incremental_ms", median(own.incrementalMs)},
            {"incremental_ratio", medianRatio(own.incrementalMs, own.lampMs)},
            {"ms_by_light_coefficients", msByCount}};
}

void printBenchRelight(const Json& result) {
    const auto number = [](const Json& value) { return value.get<double>(); };
    fmt::print("{}, {} vertices, {} light coefficients, {:.1f} GB/s copied\n\n",
               result["device"].get<std::string>(), result["vertices"].dump(),
               result["light_coefficients"].dump(), number(result["device_gb_per_s"]));
    fmt::print("{:10}{:>9}{:>9}{:>10}{:>12}{:>10}{:>10}{:>10}{:>12}{:>10}{:>13}\n", "", "ms", "CPU, ms",
               "floor, ms", "bytes/vertex", "of rows", "of CSR", "MB read", "relit error", "lamp, ms",
               "moved, ms");
    for (const auto& [name, layout] : result["layouts"].items())
        fmt::print("{:10}{:9.2f}{:9.2f}{:10.2f}{:12.0f}{:10.2f}{:10.2f}{:10.1f}{:12.4f}{:10.2f}{:13.2f}\n",
                   name, number(layout["ms"]), number(layout["cpu_ms"]), number(layout["floor_ms"]),
                   number(layout["bytes_per_vertex"]), number(layout["ratio_to_rows"]),
                   number(layout["ratio_to_eigen_csr"]), 1e-6 * number(layout["bytes_touched"]),
                   number(layout["relit_error"]), number(layout["lamp_ms"]),
                   number(layout["incremental_ms"]));
    fmt::print("{:10}{:9.2f}\n", "Eigen CSR", number(result["eigen_csr_ms"]));
    fmt::print("{:10}{:9.2f}\n", "light", number(result["light_ms"]));
    fmt::print("\nms from the largest light coefficients\n{:10}", "");
    const auto& counts = result["layouts"]["rows"]["ms_by_light_coefficients"];
    for (const auto& [count, ms] : counts.items()) fmt::print("{:>9}", count);
    for (const auto& [name, layout] : result["layouts"].items()) {
        fmt::print("\n{:10}", name);
        for (const auto& [count, ms] : layout["ms_by_light_coefficients"].items())
            fmt::print("{:9.2f}", number(ms));
    }
    fmt::print("\n\nWith the lamp: {} light coefficients, of which {} changed when it moved\n",
               result["lamp_coefficients"].dump(), result["lamp_changes"].dump());
}

void run(const BenchRelightArguments& arguments) {
    const Asset source = readAsset(arguments.file);
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    const RelightBenchInput input = makeInput(source, arguments);
    const RelightSeries series = benchRelight(
        *device, input, arguments.light.light(),
        {arguments.repeats, arguments.light.rotationDegrees, arguments.selection, arguments.counts},
        arguments.json);
    const double bandwidth = deviceCopyBandwidth(*device);
    Json layouts;
    for (const auto& [name, asset] : input.variants)
        layouts[name] = describe(asset, series.layouts.at(name), series, bandwidth);
    const Json result = {{"device", device->info().name},
                         {"driver", device->info().driver},
                         {"threads", tbb::info::default_concurrency()},
                         {"vertices", vertexCount(source)},
                         {"repeats", arguments.repeats},
                         {"source_coefficients", source.coefficients},
                         {"light_coefficients", median(series.lightCoefficients)},
                         {"lamp_coefficients", median(series.lampCoefficients)},
                         {"lamp_changes", median(series.lampChanges)},
                         {"device_gb_per_s", 1e-9 * bandwidth},
                         {"layouts", layouts},
                         {"eigen_csr_ms", median(series.csrMs)},
                         {"light_ms", median(series.lightMs)}};
    if (arguments.json)
        fmt::print("{}\n", result.dump(2));
    else
        printBenchRelight(result);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addBenchRelightCommand(CLI::App& bench) {
    CLI::App* command =
        bench.add_subcommand("relight", "Relight a bake from every layout, on the device and the CPU, in "
                                        "alternation");
    const auto arguments = std::make_shared<BenchRelightArguments>();
    command->add_option("FILE", arguments->file, "Bake (.relume); best of many coefficients a row")
        ->required();
    command->add_option("-N,--coefficients", arguments->coefficients, "Most coefficients of a row, in rows")
        ->check(CLI::Range(1, 24576))
        ->capture_default_str();
    CLI::Option* error =
        command->add_option("--error", arguments->error, "Error of transport in bases, weighted as light is")
            ->check(between(1e-6f, 1))
            ->capture_default_str();
    command->add_option("--budget", arguments->budget, "Bytes of transport a vertex in bases")
        ->type_name("BYTES")
        ->check(between(1, 1e6))
        ->excludes(error);
    arguments->light.add(*command);
    command
        ->add_option("--threshold", arguments->selection.threshold,
                     "Drop light coefficients below this, where the largest is 32767")
        ->type_name("VALUE")
        ->check(CLI::Range(0, kLightMaximum))
        ->default_str(fmt::format("the {} largest are kept", kDefaultLightCount));
    command
        ->add_option("--light-counts", arguments->counts,
                     "Relight from so many of the light's largest coefficients as well")
        ->type_name("COUNT,…")
        ->delimiter(',')
        ->check(CLI::Range(1, int(kMaximumLightEntries)))
        ->capture_default_str();
    arguments->device.add(*command);
    command->add_option("--repeats", arguments->repeats, "Rounds to take the medians of")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer(
        "Every round turns the light by a degree; then it adds a lamp of 3 degrees that alone would light\n"
        "white to radiance 1, and moves it by a degree: relit in full, and by what changed. The floor is\n"
        "the time to copy the bytes that the light makes a layout read and write. Relit errors are of\n"
        "tuples under all of the light, against those of FILE as it is. Eigen CSR multiplies the rows as\n"
        "sparse matrices of floats, on all cores.");
    command->callback([arguments, &bench] {
        expectNoOptions(bench, "relight");
        run(*arguments);
    });
}

} // namespace relume

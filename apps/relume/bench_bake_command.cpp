#include "apps/bench/cpu_baker.h"
#include "apps/bench/timing.h"
#include "apps/relume/bake_bench.h"
#include "apps/relume/commands.h"
#include "apps/relume/copy_bandwidth.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "engine/base/progress.h"
#include "precompute/bake/baked_options.h"
#include "precompute/bake/part_passes.h"
#include "precompute/thread_limit.h"

#include <fmt/core.h>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

struct BenchBakeArguments {
    SceneArguments scene;
    BakeArguments bake;
    DeviceArguments device;
    uint64_t vertices = 512;
    int repeats = 5;
    bool json = false;
};

constexpr const char* kRebake = "rebake";
constexpr VisibilityMethod kMethods[] = {VisibilityMethod::Raster, VisibilityMethod::Traced};

// Measurements of one path, one value per repetition.
struct PathSeries {
    std::vector<double> seconds;
    std::map<std::string, std::vector<double>> stageSeconds;
    std::vector<std::string> stages; // in order of execution
    double difference = 0;           // of its rows from the CPU's

    void add(const SampleRun& run) {
        seconds.push_back(run.seconds);
        for (const auto& [name, stage] : run.stages) {
            if (!stageSeconds.contains(name)) stages.push_back(name);
            stageSeconds[name].push_back(stage);
        }
    }
};

using StageBytes = std::function<std::optional<double>(const std::string& stage)>;

Json describe(const PathSeries& path, const PathSeries& cpu, double vertices, const StageBytes& bytes,
              double bandwidth) {
    Json stages = Json::object();
    for (const std::string& name : path.stages) {
        Json& stage = stages[name];
        stage["ms_per_vertex"] = 1e3 * median(path.stageSeconds.at(name)) / vertices;
        if (const auto moved = bytes(name)) {
            stage["bytes_per_vertex"] = *moved;
            stage["floor_ms_per_vertex"] = 1e3 * *moved / bandwidth;
        }
    }
    return {{"ms_per_vertex", 1e3 * median(path.seconds) / vertices},
            {"ratio_to_cpu", medianRatio(path.seconds, cpu.seconds)},
            {"difference_to_cpu", path.difference},
            {"stages", stages}};
}

double visibilitySeconds(const PathSeries& path, std::string_view prefix) {
    double seconds = 0;
    for (const auto& [name, values] : path.stageSeconds)
        if (name.starts_with(prefix)) seconds += median(values);
    return seconds;
}

Json describeScene(const std::string& input, const BakeSample& sample) {
    auto parts = Json::array();
    for (size_t i = 0; i < sample.points.size(); i++) {
        const AssetPart& part = sample.asset.parts[i];
        parts.push_back({{"name", part.name},
                         {"vertices", part.mesh.vertexCount()},
                         {"sampled", sample.points[i].size()},
                         {"terms", termCount(part)}});
    }
    return {{"input", input},
            {"vertices", sample.vertices()},
            {"occluder_triangles", sample.asset.occluder.triangleCount()},
            {"parts", parts}};
}

// Describes the options without the visibility method, since every method is timed.
Json describeCommonOptions(const BakeOptions& options) {
    Json described = Json::parse(describeOptions(options));
    described.erase("visibility");
    return described;
}

// Runs the paths in alternation. The first round warms up, and measures the difference of rows from the
// CPU's.
std::map<std::string, PathSeries>
runPaths(const std::vector<std::pair<std::string, std::unique_ptr<BakePath>>>& paths, int repeats,
         int faceSize, bool quiet) {
    std::map<std::string, PathSeries> series;
    Progress progress("baking the sample", uint64_t(repeats + 1) * paths.size(), "runs", quiet);
    uint64_t done = 0;
    SampleRows cpuRows;
    for (int repeat = 0; repeat <= repeats; repeat++)
        for (const auto& [name, path] : paths) {
            SampleRun run = path->run();
            if (repeat > 0)
                series[name].add(run);
            else if (name == "cpu")
                cpuRows = std::move(run.rows);
            else
                series[name].difference = relativeDifference(run.rows, cpuRows, faceSize);
            progress.update(++done);
        }
    return series;
}

void printBenchBake(const Json& result) {
    const auto number = [](const Json& value) { return value.get<double>(); };
    fmt::print("{}, {} threads; {} of {} vertices\n", result["device"].get<std::string>(),
               result["threads"].dump(), result["vertices"].dump(), result["scene"]["vertices"].dump());
    fmt::print("copying memory: device {:.1f} GB/s, host {:.1f} GB/s, read and written\n\n",
               number(result["bandwidth"]["device_gb_per_s"]), number(result["bandwidth"]["host_gb_per_s"]));
    fmt::print("{:28}{:>10}{:>12}{:>12}{:>8}\n", "", "ms/vertex", "KiB/vertex", "floor, ms", "of CPU");
    for (const auto& [name, path] : result["paths"].items()) {
        fmt::print("{:28}{:10.3f}{:>12}{:>12}{:8.2f}\n", name, number(path["ms_per_vertex"]), "", "",
                   number(path["ratio_to_cpu"]));
        for (const auto& [stageName, stage] : path["stages"].items()) {
            fmt::print("  {:26}{:10.3f}", stageName, number(stage["ms_per_vertex"]));
            if (stage.contains("bytes_per_vertex"))
                fmt::print("{:12.0f}{:12.3f}", number(stage["bytes_per_vertex"]) / 1024,
                           number(stage["floor_ms_per_vertex"]));
            fmt::print("\n");
        }
        if (path.contains("rays_per_second"))
            fmt::print("  {:.1f} million rays per second\n", 1e-6 * number(path["rays_per_second"]));
        if (path.contains("triangles_per_second"))
            fmt::print("  {:.1f} million triangles per second, {:.0f} per vertex\n",
                       1e-6 * number(path["triangles_per_second"]), number(path["triangles_per_vertex"]));
        if (path.contains("ratio_to_traced"))
            fmt::print("  {:.2f} of the traced bake\n", number(path["ratio_to_traced"]));
        if (name != "cpu")
            fmt::print("  rows differ from the CPU's by {:.2f} %\n", 100 * number(path["difference_to_cpu"]));
    }
}

void run(BenchBakeArguments& arguments) {
    arguments.bake.resolve();
    const BakeOptions& options = arguments.bake.options;
    Scene scene = arguments.scene.load(arguments.bake.options.refinement.has_value());
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    const BakeSample sample = sampleBake(*device, std::move(scene), options, arguments.vertices);

    auto cpuPath = std::make_unique<CpuPath>(sample, options);
    const CpuPath& cpuCounts = *cpuPath;
    std::vector<std::pair<std::string, std::unique_ptr<BakePath>>> paths;
    paths.emplace_back("cpu", std::move(cpuPath));
    for (VisibilityMethod method : kMethods) {
        if (!canUse(*device, method)) continue;
        paths.emplace_back(visibilityMethodName(method),
                           std::make_unique<DevicePath>(*device, sample, options, method));
    }
    paths.emplace_back(kRebake, std::make_unique<RebakePath>(*device, sample, options));
    const auto series = runPaths(paths, arguments.repeats, options.faceSize, arguments.json);

    const auto vertices = double(sample.sampled()), rays = double(cpuCounts.rays());
    const auto triangles = double(countDrawnTriangles(*device, sample, options));
    const auto threads = int(allowedThreads());
    const double deviceBandwidth = deviceCopyBandwidth(*device), hostBandwidth = hostCopyBandwidth(threads);
    const BakeTraffic traffic(sample, options, rays / vertices, triangles / vertices);
    Json described;
    for (const auto& [name, path] : paths) {
        const PathSeries& own = series.at(name);
        const bool isCpu = name == "cpu";
        Json& entry = described[name];
        entry = describe(
            own, series.at("cpu"), vertices,
            [&](const std::string& stage) { return isCpu ? traffic.cpu(stage) : traffic.device(stage); },
            isCpu ? hostBandwidth : deviceBandwidth);
        const double seconds = visibilitySeconds(own, "visibility");
        if (name == visibilityMethodName(VisibilityMethod::Raster)) {
            entry["triangles_per_vertex"] = triangles / vertices;
            entry["triangles_per_second"] = triangles / visibilitySeconds(own, "visibility draw");
        } else if (name == kRebake) {
            const auto traced = series.find(std::string(visibilityMethodName(VisibilityMethod::Traced)));
            if (traced != series.end())
                entry["ratio_to_traced"] = medianRatio(own.seconds, traced->second.seconds);
        } else {
            entry["rays_per_vertex"] = rays / vertices;
            entry["rays_per_second"] = rays / seconds;
        }
    }
    const Json result = {
        {"device", device->info().name},
        {"driver", device->info().driver},
        {"threads", threads},
        {"vertices", sample.sampled()},
        {"repeats", arguments.repeats},
        {"scene", describeScene(arguments.scene.input, sample)},
        {"options", describeCommonOptions(options)},
        {"bandwidth", {{"device_gb_per_s", 1e-9 * deviceBandwidth}, {"host_gb_per_s", 1e-9 * hostBandwidth}}},
        {"paths", described}};
    if (arguments.json)
        fmt::print("{}\n", result.dump(2));
    else
        printBenchBake(result);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addBenchBakeCommand(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "bake", "Bake a sample of vertices on the CPU and in each of the device's ways, in alternation");
    const auto arguments = std::make_shared<BenchBakeArguments>();
    arguments->scene.add(*command);
    arguments->bake.add(*command, false);
    arguments->device.add(*command);
    command->add_option("--vertices", arguments->vertices, "Vertices to bake, about: runs of 64 neighbors")
        ->type_name("COUNT")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--repeats", arguments->repeats, "Rounds to take the medians of")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer(
        "The CPU traces with Embree on all threads; rebake takes visibility as a file keeps it. Every path\n"
        "bakes the same vertices; medians are per vertex, the floor of a stage is the time to copy the "
        "bytes\n"
        "that it moves.");
    command->callback([arguments, command, &bench] {
        expectNoOptions(bench, "bake");
        if (command->get_option("--visibility")->count() > 0)
            throw UsageError("--visibility: bench bake times every way; leave it out");
        run(*arguments);
    });
}

} // namespace relume

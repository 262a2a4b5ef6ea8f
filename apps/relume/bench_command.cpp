#include "apps/bench/timing.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace relume {

namespace {

struct BenchArguments {
    SceneArguments scene;
    BakeArguments bake;
    LightArguments light;
    DeviceArguments device;
    int repeats = 9;
    bool json = false;
};

constexpr int kWidth = 1280, kHeight = 720;

// Returns the median wall-clock milliseconds of recording, submitting and waiting for `work`, after one
// warm-up.
template <typename Work>
double medianMilliseconds(vk::Commands& commands, int repeats, const Work& work) {
    std::vector<double> times;
    for (int repeat = 0; repeat <= repeats; repeat++) {
        const double elapsed = milliseconds([&] {
            commands.begin();
            work(repeat);
            commands.submitAndWait();
        });
        if (repeat > 0)
            times.push_back(elapsed);
        else
            commands.clearTimes();
    }
    return median(times);
}

nlohmann::ordered_json perRepeat(const vk::PassTimes& times, int repeats) {
    nlohmann::ordered_json passes;
    for (const auto& [name, seconds] : times) passes[name] = 1e3 * seconds / repeats;
    return passes;
}

uint64_t peakHostMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024;
}

void printBench(const nlohmann::ordered_json& result) {
    fmt::print("{}, {} vertices\n", result["device"].get<std::string>(), result["bake"]["vertices"].dump());
    fmt::print("bake              {:8.3f} ms per vertex, {:.1f} s\n",
               result["bake"]["ms_per_vertex"].get<double>(), result["bake"]["seconds"].get<double>());
    for (const auto& [name, stage] : result["bake"]["stages"].items())
        fmt::print("  {:22} {:8.3f} ms per vertex  {:5.1f} %\n", name, stage["ms_per_vertex"].get<double>(),
                   100 * stage["share"].get<double>());
    fmt::print("light change      {:8.2f} ms\n", result["light_change_ms"].get<double>());
    for (const auto& [name, ms] : result["light_change"].items())
        fmt::print("  {:22} {:8.2f} ms\n", name, ms.get<double>());
    fmt::print("view change       {:8.2f} ms at {} x {}\n", result["view_change_ms"].get<double>(), kWidth,
               kHeight);
    fmt::print("peak host memory  {:8.0f} MiB\n",
               double(result["host_memory_bytes"].get<uint64_t>()) / (1 << 20));
}

void run(BenchArguments& arguments) {
    arguments.bake.resolve();
    Scene scene = arguments.scene.load(arguments.bake.options.refinement.has_value());
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    BakeTimes times;
    const Asset asset =
        bakeWithProgress(*device, std::move(scene), arguments.bake.options, arguments.json, times);

    LightPass light(*device, asset.faceSize);
    light.setLight(arguments.light.light());
    Relighter relighter(*device, asset);
    ViewPass view(*device, asset, {.width = kWidth, .height = kHeight});
    CameraArguments view16by9;
    view16by9.width = kWidth;
    view16by9.height = kHeight;
    vk::Commands commands(*device, "bench");
    // Every light change rotates the light slightly, and is relit in full even if nothing changes.
    relighter.setMode(RelightMode::Full);
    const double lightChange = medianMilliseconds(commands, arguments.repeats, [&](int repeat) {
        light.record(commands, radians(arguments.light.rotationDegrees + float(repeat)));
        relighter.record(commands, light);
    });
    const nlohmann::ordered_json lightPasses = perRepeat(commands.times(), arguments.repeats);
    const double viewChange = medianMilliseconds(commands, arguments.repeats, [&](int repeat) {
        view.record(commands, view16by9.camera(asset, glm::radians(float(repeat))), relighter);
    });

    const nlohmann::ordered_json result = {{"device", device->info().name},
                                           {"driver", device->info().driver},
                                           {"bake", describeTimes(times, vertexCount(asset))},
                                           {"light_change_ms", lightChange},
                                           {"light_change", lightPasses},
                                           {"light_coefficients", light.readVector().indices.size()},
                                           {"view_change_ms", viewChange},
                                           {"host_memory_bytes", peakHostMemory()}};
    if (arguments.json)
        fmt::print("{}\n", result.dump(2));
    else
        printBench(result);
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void expectNoOptions(const CLI::App& command, const char* subcommand) {
    for (const CLI::Option* option : command.get_options())
        if (option->count() > 0)
            throw UsageError(fmt::format("{}: {} comes before {}, where it means nothing; put it after",
                                         command.get_name(), option->get_name(), subcommand));
}

void addBenchCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("bench", "Time bake, light change and view change, stage by stage");
    const auto arguments = std::make_shared<BenchArguments>();
    arguments->scene.add(*command);
    arguments->bake.add(*command);
    arguments->light.add(*command);
    arguments->device.add(*command);
    command->add_option("--repeats", arguments->repeats, "Light and view changes to take the median of")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer(
        "`relume bench bake --help`: baking on the CPU beside the device's ways, stage by stage.\n"
        "`relume bench relight --help`: relighting from every layout, beside the CPU and a library.\n"
        "`relume bench view --help`: view changes and whole frames of bakes.");
    addBenchBakeCommand(*command);
    addBenchRelightCommand(*command);
    addBenchViewCommand(*command);
    // CLI11 also runs this after a subcommand's own callback.
    command->callback([arguments, command] {
        if (command->get_subcommands().empty()) run(*arguments);
    });
}

} // namespace relume

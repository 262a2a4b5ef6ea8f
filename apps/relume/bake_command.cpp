#include "apps/relume/bake_report.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"
#include "precompute/thread_limit.h"

#include <algorithm>
#include <optional>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct Arguments {
    SceneArguments scene;
    BakeArguments bake;
    DeviceArguments device;
    std::filesystem::path output, timings;
    BakeLimits limits;
    std::optional<std::string> shard; // none: all
    int threads = 0;   // as many as there are
    bool quiet = false, json = false;
};

// Outputs are tried before the work, not after it.
void checkOutputs(const Arguments& arguments) {
    if (arguments.output.extension() != ".relume")
        throw UsageError("--output: expected a name ending in .relume, found \"{}\"",
                         arguments.output.string());
    expectWritable(arguments.output);
    if (!arguments.timings.empty()) expectWritable(arguments.timings);
}

// Bakes, and says what was made; ends the command where it was stopped.
BakeSummary bakeStoppably(const vk::Device& device, Scene scene, const Arguments& arguments,
                          const std::optional<Shard>& shard, ReportStyle style) {
    BakeReport report(style, true);
    try {
        const BakeSummary summary = bakeToFile(device, std::move(scene), arguments.bake.options,
                                               arguments.output, arguments.limits, report, shard);
        report.close();
        const auto bytes = std::filesystem::file_size(arguments.output);
        const uint64_t baked = summary.vertices - summary.resumed;
        report.event("done", {{"output", arguments.output.string()},
                              {"bytes", bytes},
                              {"vertices", summary.vertices},
                              {"baked", baked},
                              {"seconds", summary.times.total}});
        spdlog::info("{}: {:.1f} MB, {} vertices in {:.1f} s ({:.2f} ms each) on {}",
                     arguments.output.string(), double(bytes) * 1e-6, baked, summary.times.total,
                     1e3 * summary.times.total / double(std::max<uint64_t>(baked, 1)), device.name());
        return summary;
    } catch (const BakeStopped&) {
        report.close();
        report.event("stopped", {{"signal", caughtInterrupt()},
                                 {"done", report.done()},
                                 {"vertices", report.vertices()},
                                 {"checkpoint", checkpointPath(arguments.output).string()}});
        spdlog::warn("stopped after {} of {} vertices, kept in {}; the same command goes on from there",
                     report.done(), report.vertices(), checkpointPath(arguments.output).string());
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

void run(Arguments& arguments) {
    arguments.bake.resolve();
    std::optional<Shard> shard;
    if (arguments.shard) shard = parseShard(*arguments.shard);
    // Each machine would measure for itself, and might choose differently.
    if (shard && !arguments.bake.options.visibilityMethod)
        throw UsageError(
            "--shard: all shards must find visibility the same way; name it: --visibility traced "
            "or raster, not auto");
    std::optional<ThreadLimit> threadLimit;
    if (arguments.threads > 0) threadLimit.emplace(arguments.threads);
    checkOutputs(arguments);
    Scene scene = arguments.scene.load();
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    for (const Part& part : scene.parts)
        spdlog::info("{}: {} vertices, {} triangles, {}", part.name, part.mesh.vertexCount(),
                     part.mesh.triangleCount(), part.material);

    const ReportStyle style = arguments.json    ? ReportStyle::Json
                              : arguments.quiet ? ReportStyle::Quiet
                                                : ReportStyle::Text;
    const BakeSummary summary = bakeStoppably(*device, std::move(scene), arguments, shard, style);
    const BakeTimes& times = summary.times;
    const uint64_t baked = std::max<uint64_t>(summary.vertices - summary.resumed, 1);
    if (!arguments.timings.empty())
        writeFileAtomically(arguments.timings, describeTimes(times, baked).dump(2) + "\n");
    DeviceArguments::expectNoMessages(*device);
}

} // namespace

void addBakeCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("bake", "Bake a mesh or scene into a .relume file");
    const auto arguments = std::make_shared<Arguments>();
    arguments->scene.add(*command);
    command->add_option("-o,--output", arguments->output, "Bake to write (.relume)")
        ->type_name("FILE")
        ->required();
    arguments->bake.add(*command);
    arguments->device.add(*command);
    command->add_option("--timings", arguments->timings, "Write stage timings as JSON")->type_name("FILE");
    command
        ->add_option("--memory", arguments->limits.memory,
                     "Most memory that a batch of vertices may take, on device and host: 512M, 2G")
        ->type_name("SIZE")
        ->transform(CLI::AsSizeValue(false));
    command->add_option("--threads", arguments->threads, "Most host threads that work at a time")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    command
        ->add_option("--shard", arguments->shard,
                     "Bake every N-th block of vertices from the I-th on, I from 0 to N - 1, into a part for "
                     "`relume merge`: docs/many_machines.md")
        ->type_name("I/N");
    command->add_flag("-q,--quiet", arguments->quiet, "Show no progress");
    command->add_flag("--json", arguments->json,
                      "Print events on stdout, a JSON object a line: docs/baking.md lists them");
    command->footer(
        "With no INPUT it bakes a built-in torus knot: relume bake -o knot.relume\n"
        "A material with parameters: -m '{\"model\": \"ashikhmin-shirley\", \"nu\": 50, \"nv\": 50}'\n"
        "`relume materials` lists presets and models.\n"
        "What is baked is kept in FILE.checkpoint until all is done: after Ctrl-C, a crash or a full disk "
        "the\n"
        "same command goes on from there. Stopped by Ctrl-C it exits with 130, by SIGTERM with 143.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

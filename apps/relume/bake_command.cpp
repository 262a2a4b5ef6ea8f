#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "engine/base/file.h"

#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct Arguments {
    SceneArguments scene;
    BakeArguments bake;
    DeviceArguments device;
    std::filesystem::path output, timings;
    bool quiet = false;
};

// Outputs are tried before the work, not after it.
void checkOutputs(const Arguments& arguments) {
    if (arguments.output.extension() != ".relume")
        throw UsageError("--output: expected a name ending in .relume, found \"{}\"",
                         arguments.output.string());
    expectWritable(arguments.output);
    if (!arguments.timings.empty()) expectWritable(arguments.timings);
}

void run(Arguments& arguments) {
    arguments.bake.resolve();
    const BakeOptions& options = arguments.bake.options;
    checkOutputs(arguments);
    Scene scene = arguments.scene.load();
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    for (const Part& part : scene.parts)
        spdlog::info("{}: {} vertices, {} triangles, {}", part.name, part.mesh.vertexCount(),
                     part.mesh.triangleCount(), part.material);

    BakeTimes times;
    Asset asset = bakeWithProgress(*device, std::move(scene), options, arguments.quiet, times);
    asset.provenance.program = "relume " RELUME_VERSION;
    writeAsset(arguments.output, asset);
    const uint64_t vertices = vertexCount(asset);
    spdlog::info("{}: {:.1f} MB, {} vertices in {:.1f} s ({:.2f} ms each) on {}", arguments.output.string(),
                 double(std::filesystem::file_size(arguments.output)) * 1e-6, vertices, times.total,
                 1e3 * times.total / double(vertices), device->name());
    if (!arguments.timings.empty())
        writeFileAtomically(arguments.timings, describeTimes(times, vertices).dump(2) + "\n");
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
    command->add_flag("-q,--quiet", arguments->quiet, "Show no progress");
    command->footer(
        "With no INPUT it bakes a built-in torus knot: relume bake -o knot.relume\n"
        "A material with parameters: -m '{\"model\": \"ashikhmin-shirley\", \"nu\": 50, \"nv\": 50}'\n"
        "`relume materials` lists presets and models.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

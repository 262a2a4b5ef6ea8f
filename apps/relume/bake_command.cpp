#include "apps/relume/bake_job.h"
#include "apps/relume/commands.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"

namespace relume {

namespace {

struct BakeCommandArguments {
    SceneArguments scene;
    BakeArguments bake;
    BakeJob job;
    std::optional<std::string> shard; // none: all blocks
    bool preview = false;
};

void run(BakeCommandArguments& arguments) {
    arguments.bake.resolve();
    BakeOptions& options = arguments.bake.options;
    BakeJob& job = arguments.job;
    std::optional<Shard> shard;
    if (arguments.shard) shard = parseShard(*arguments.shard);
    options.keepVisibility = job.keepVisibility;
    job.prepare();
    CommandFiles files;
    Scene scene = arguments.scene.load(arguments.bake.options.refinement.has_value());
    job.addOutputs(files);
    files.check();
    const std::unique_ptr<vk::Device> device = job.device.open();
    for (const Part& part : scene.parts) logPart(part.name, part.mesh, part.material);
    job.run(*device, [&](BakeObserver& observer) {
        return bakeToFile(*device, std::move(scene), options, job.output, job.limits, observer,
                          {shard, arguments.preview});
    });
}

} // namespace

void addBakeCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("bake", "Bake a mesh or scene into a .relume file");
    const auto arguments = std::make_shared<BakeCommandArguments>();
    arguments->scene.add(*command);
    arguments->bake.add(*command);
    arguments->job.add(*command);
    CLI::Option* shard =
        command
            ->add_option(
                "--shard", arguments->shard,
                "Bake every N-th block of vertices from the I-th on, I from 0 to N - 1, into a part for "
                "`relume merge`: docs/many_machines.md")
            ->type_name("I/N");
    command
        ->add_flag(
            "--preview", arguments->preview,
            "Write a preview first, of a twelfth of the vertices and others interpolated from these, and "
            "again as the bake goes")
        ->excludes(shard)
        ->excludes(command->get_option("--keep-visibility"));
    command->footer(
        "With no INPUT it bakes a built-in torus knot: relume bake -o knot.relume\n"
        "A material with parameters: -m '{\"model\": \"ashikhmin-shirley\", \"nu\": 50, \"nv\": 50}'\n"
        "`relume materials` lists presets and models.\n"
        "What is baked is kept in FILE.checkpoint until all is done: after Ctrl-C, a crash or a full disk "
        "the\n"
        "same command goes on from there. Visibility that FILE keeps from an earlier bake of the same scene "
        "is\n"
        "used again. Stopped by Ctrl-C it exits with 130, by SIGTERM with 143.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

#include "apps/relume/bake_report.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "apps/relume/studied_light.h"
#include "engine/base/error.h"
#include "engine/base/progress.h"
#include "precompute/bake/bake_options.h"
#include "precompute/error/advice.h"
#include "precompute/error/study_json.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

struct AdviseArguments {
    SceneArguments scene;
    StudiedLightArguments light;
    DeviceArguments device;
    double error = 0;
    int points = 600;
    bool asIs = false;
    bool json = false;
};

void print(const std::optional<AdvisedBake>& bake, uint64_t vertices) {
    if (!bake) return;
    fmt::print("  relume bake … {}\n", commandLineOf(bake->options));
    const std::string time = bake->seconds ? fmt::format(", baked in about {:.0f} s", *bake->seconds) : "";
    fmt::print("    error {:.4f}, {:.1f} MB of transport ({:.0f} bytes a vertex){}\n", bake->error,
               bake->bytes * 1e-6, bake->bytes / double(vertices), time);
}

void print(const char* title, const MeshAdvice& advice) {
    fmt::print("{}, {} vertices:\n", title, advice.vertices);
    print(advice.bases, advice.vertices);
    print(advice.rows, advice.vertices);
    fmt::print("    least error by terms:");
    for (size_t terms = 1; terms <= advice.leastErrors.size(); terms = terms < 4 ? terms + 1 : terms + 4)
        fmt::print("  {}: {:.4f}", terms, advice.leastErrors[terms - 1]);
    fmt::print("\n");
}

void print(const Advice& advice) {
    if (const AdvisedBake* best = advice.best())
        fmt::print("of fewest bytes: relume bake … {}\n\n", commandLineOf(best->options));
    print("mesh as it is", advice.plain);
    if (advice.refined) print("refined", *advice.refined);
}

void run(AdviseArguments& arguments) {
    const StudiedLight light = arguments.light.studied();
    AdviceRequest request{arguments.scene.load(false), {}, arguments.error};
    request.options.bounces = presetOptions(BakePreset::Default).bounces;
    request.options.areBouncesAuto = true;
    request.points = size_t(arguments.points);
    if (!arguments.asIs) request.refinable = arguments.scene.load(true);
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    const size_t points = request.points;
    Progress progress("looking", points, "points");
    BakeObserver observer;
    const Advice advice = advise(*device, std::move(request), light, observer,
                                 [&](double share) { progress.update(uint64_t(double(points) * share)); });
    if (arguments.json) {
        fmt::print("{}\n", describe(advice, arguments.error).dump(2));
    } else {
        print(advice);
    }
    DeviceArguments::expectNoMessages(*device);
    if (!advice.best()) {
        double least = std::ranges::min(advice.plain.leastErrors);
        if (advice.refined) least = std::min(least, std::ranges::min(advice.refined->leastErrors));
        throw Error(fmt::format(
            "an error of {} is not reached: with all coefficients and as many as {} terms it is {:.3g}; "
            "ask for a larger one, keep more of the light (--coefficients, here of the light), or take "
            "a finer mesh",
            arguments.error, kMostTerms, least));
    }
}

} // namespace

void addAdviseCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "advise",
        "Find the least that a bake must be for images of an error, for a mesh, material and light");
    const auto arguments = std::make_shared<AdviseArguments>();
    arguments->scene.add(*command);
    command
        ->add_option("--error", arguments->error,
                     "Wanted error of images: root mean square over pixels, relative to the exact image's")
        ->type_name("ERROR")
        ->required()
        ->check(between(0.001f, 1));
    command
        ->add_option("--points", arguments->points, "Points of the surface that are looked at: more is surer")
        ->type_name("COUNT")
        ->check(CLI::Range(40, 40000))
        ->capture_default_str();
    command->add_flag("--as-is", arguments->asIs, "Leave vertices as they are; takes half as long, about");
    arguments->light.add(*command);
    arguments->device.add(*command);
    command->add_flag("--json", arguments->json, "Data on stdout instead of words");
    command->footer(
        "For instance: relume advise bunny.obj --ground -m clay -e forest.exr --error 0.03\n"
        "It looks at the object from four sides, under the light as it is given.\n"
        "What it prints are options of `relume bake`, whose --error is that of its transport and\n"
        "whose --coefficients are those of rows. docs/errors.md says how it knows.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

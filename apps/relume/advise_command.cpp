#include "apps/relume/bake_report.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "apps/relume/scene_arguments.h"
#include "apps/relume/studied_light.h"
#include "engine/base/error.h"
#include "engine/base/progress.h"
#include "precompute/error/advice.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

struct Arguments {
    SceneArguments scene;
    StudiedLightArguments light;
    DeviceArguments device;
    double error = 0;
    bool json = false;
};

nlohmann::ordered_json describe(const std::optional<AdvisedBake>& bake, uint64_t vertices) {
    if (!bake) return nullptr;
    nlohmann::ordered_json json = {{"terms", bake->options.factorization.terms}};
    if (bake->options.layout.layout == TransportLayout::Rows)
        json["coefficients"] = bake->options.coefficients;
    else
        json["layout_error"] = bake->options.layout.error;
    json["error"] = bake->error;
    json["bytes"] = bake->bytes;
    json["bytes_per_vertex"] = bake->bytes / double(vertices);
    json["seconds"] = bake->seconds;
    return json;
}

std::string optionsOf(const BakeOptions& options) {
    if (options.layout.layout == TransportLayout::Rows)
        return fmt::format("--terms {} --layout rows --coefficients {}", options.factorization.terms,
                           options.coefficients);
    return fmt::format("--terms {} --error {:.3g}", options.factorization.terms, options.layout.error);
}

void print(const char* title, const AdvisedBake& bake, uint64_t vertices) {
    fmt::print("{:<12} relume bake … {}\n", title, optionsOf(bake.options));
    fmt::print("             error {:.4f}, {:.1f} MB of transport ({:.0f} bytes a vertex), about {:.0f} s\n",
               bake.error, bake.bytes * 1e-6, bake.bytes / double(vertices), bake.seconds);
}

void print(const Advice& advice) {
    if (advice.bases) print("in bases:", *advice.bases, advice.vertices);
    if (advice.rows) print("in rows:", *advice.rows, advice.vertices);
    fmt::print("least error by K, all coefficients kept:");
    for (size_t terms = 1; terms <= advice.leastErrors.size(); terms++)
        if (terms <= 4 || terms % 4 == 0 || terms == advice.leastErrors.size())
            fmt::print("  {}: {:.4f}", terms, advice.leastErrors[terms - 1]);
    fmt::print("\n");
}

void run(Arguments& arguments) {
    const StudiedLight light = arguments.light.studied();
    AdviceRequest request{arguments.scene.load(), arguments.error, {}};
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    Progress progress("looking", request.points, "points");
    BakeObserver observer;
    const Advice advice = advise(*device, request, light, observer, [&](double share) {
        progress.update(uint64_t(double(request.points) * share));
    });
    if (arguments.json)
        fmt::print("{}\n", nlohmann::ordered_json({{"asked", arguments.error},
                                                   {"vertices", advice.vertices},
                                                   {"bases", describe(advice.bases, advice.vertices)},
                                                   {"rows", describe(advice.rows, advice.vertices)},
                                                   {"least_errors", advice.leastErrors}})
                               .dump(2));
    else
        print(advice);
    DeviceArguments::expectNoMessages(*device);
    if (!advice.bases && !advice.rows)
        throw Error("an error of {} is not reached: with {} terms and all coefficients it is {:.3g}; ask for "
                    "more, or take a finer mesh",
                    arguments.error, advice.leastErrors.size(), advice.leastErrors.back());
}

} // namespace

void addAdviseCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "advise",
        "Find the least that a bake must be for images of an error, for a mesh, material and light");
    const auto arguments = std::make_shared<Arguments>();
    arguments->scene.add(*command);
    command
        ->add_option("--error", arguments->error,
                     "Wanted error of images: root mean square over pixels, relative to the exact image's")
        ->type_name("ERROR")
        ->required()
        ->check(between(0.001f, 1));
    arguments->light.add(*command);
    arguments->device.add(*command);
    command->add_flag("--json", arguments->json, "Data on stdout instead of words");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

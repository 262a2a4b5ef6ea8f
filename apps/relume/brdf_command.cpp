#include "apps/relume/brdf_report.h"
#include "apps/relume/command_files.h"
#include "apps/relume/commands.h"
#include "apps/relume/factorization_arguments.h"
#include "apps/relume/map_sheet.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/environment_file.h"
#include "engine/import/image_file.h"
#include "precompute/brdf/tabulation.h"

#include <fmt/core.h>
#include <memory>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

constexpr int kLightSize = 64; // side of the cube under which radiance errors are measured

struct BrdfArguments {
    std::string material;
    int size = 48;
    FactorizationArguments factorization;
    std::vector<std::string> environments;
    std::filesystem::path maps;
    bool json = false;
};

void checkOutput(const std::filesystem::path& maps) {
    if (maps.empty()) return;
    expectExtension("--maps", maps, ".png");
    expectWritable(maps);
}

constexpr FactorizationOptions kStudied{.terms = 16};

void run(BrdfArguments& arguments) {
    arguments.factorization.resolve(kStudied);
    checkOutput(arguments.maps);
    CommandFiles files;
    const std::unique_ptr<Brdf> brdf = makeBrdf(arguments.material);
    std::vector<NamedLight> lights;
    for (const std::string& file : arguments.environments)
        lights.push_back({file, sampleEnvironment(prepareForSampling(readEnvironment(file)), kLightSize, 0)});

    files.addOutput("--maps", arguments.maps);
    files.check();

    const FactorizationArguments& how = arguments.factorization;
    const BrdfReport report = reportOn(*brdf, arguments.size, how.mapping, how.options, lights);
    if (arguments.json)
        fmt::print("{}\n", describeReport(report).dump(2));
    else
        fmt::print("{}", tableOf(report));

    if (!arguments.maps.empty()) writePng(arguments.maps, drawMapSheet(report.factored));
    spdlog::info("{} directions tabulated in {:.2f} s, {} terms factored in {:.2f} s", report.directions,
                 report.tabulationSeconds, report.factored.terms, report.factorizationSeconds);
}

} // namespace

void addBrdfCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("brdf", "Factor a BRDF as a bake does, and say how far its terms are from it");
    const auto arguments = std::make_shared<BrdfArguments>();
    command->add_option("MATERIAL", arguments->material, "Preset, model, JSON object, or file of either")
        ->required();
    arguments->factorization.add(*command, kStudied);
    command
        ->add_option("--size", arguments->size,
                     fmt::format("Side of a light or view map, {} to {}", kMinMapSize, kMaxMapSize))
        ->type_name("S")
        ->check(CLI::Range(kMinMapSize, kMaxMapSize))
        ->capture_default_str();
    command
        ->add_option("-e,--environment", arguments->environments,
                     "Measure the error of reflected radiance under this, too (.exr, .hdr); may be repeated")
        ->type_name("FILE")
        ->allow_extra_args(false); // otherwise it would take MATERIAL as well
    command
        ->add_option("--maps", arguments->maps,
                     "Write the first 8 light maps: each over its largest magnitude, magenta where negative")
        ->type_name("PNG");
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer("Errors are relative, after each term: Frobenius over the table, RMS of f cos cos over "
                    "80,000 pairs\nof directions (first absolute), reflected radiance as expected under "
                    "environments in general, and\nas measured under the given ones. Terms of factorization "
                    "nonnegative are only good together.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

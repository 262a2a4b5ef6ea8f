#include "apps/plot/map_sheet.h"
#include "apps/relume/brdf_report.h"
#include "apps/relume/command_files.h"
#include "apps/relume/commands.h"
#include "apps/relume/factorization_arguments.h"
#include "apps/relume/lobe_plot.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/environment_file.h"
#include "engine/import/image_file.h"

#include <fmt/format.h>
#include <memory>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

constexpr int kLightSize = 64; // a side of the cube that radiance errors are measured under

struct Arguments {
    std::string material;
    int size = 48;
    FactorizationArguments factorization;
    std::vector<std::string> environments;
    std::filesystem::path maps, plot, slice;
    bool json = false;
};

void checkOutput(const char* option, const std::filesystem::path& path, const char* extension) {
    if (path.empty()) return;
    if (path.extension() != extension)
        throw UsageError(
            fmt::format("{}: expected a name ending in {}, found \"{}\"", option, extension, path.string()));
    expectWritable(path);
}

// To what fits above a plot; UTF-8 stays whole.
std::string shortened(const std::string& text) {
    constexpr size_t kMost = 50;
    if (text.size() <= kMost) return text;
    size_t end = kMost;
    while (end > 0 && (text[end] & 0xc0) == 0x80) end--;
    return text.substr(0, end) + "…";
}

constexpr FactorizationOptions kStudied{.terms = 16};

void run(Arguments& arguments) {
    arguments.factorization.resolve(kStudied);
    checkOutput("--maps", arguments.maps, ".png");
    checkOutput("--plot", arguments.plot, ".svg");
    checkOutput("--slice", arguments.slice, ".svg");
    CommandFiles files;
    const std::unique_ptr<Brdf> brdf = makeBrdf(arguments.material);
    std::vector<NamedLight> lights;
    for (const std::string& file : arguments.environments)
        lights.push_back({file, sampleEnvironment(prepareForSampling(readEnvironment(file)), kLightSize, 0)});

    files.addOutput("--maps", arguments.maps);
    files.addOutput("--plot", arguments.plot);
    files.addOutput("--slice", arguments.slice);
    files.check();

    const FactorizationArguments& how = arguments.factorization;
    const BrdfReport report = reportOn(*brdf, arguments.size, how.mapping, how.options, lights);
    if (arguments.json)
        fmt::print("{}\n", describeReport(report).dump(2));
    else
        fmt::print("{}", tableOf(report));

    const std::string title =
        fmt::format("{}, factorization {}", shortened(arguments.material), factorizationName(report.method));
    if (!arguments.maps.empty()) writePng(arguments.maps, drawMapSheet(report.factored));
    if (!arguments.plot.empty()) writeFileAtomically(arguments.plot, plotOf(report, title));
    if (!arguments.slice.empty())
        writeFileAtomically(arguments.slice, drawLobes(*brdf, report.factored, title));
    spdlog::info("{} directions tabulated in {:.2f} s, {} terms factored in {:.2f} s", report.directions,
                 report.tabulationSeconds, report.factored.terms, report.factorizationSeconds);
}

} // namespace

void addBrdfCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("brdf", "Factor a BRDF as a bake does, and say how far its terms are from it");
    const auto arguments = std::make_shared<Arguments>();
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
        ->allow_extra_args(false); // or it would take MATERIAL as well
    command
        ->add_option("--maps", arguments->maps,
                     "Write the first 8 light maps: each over its largest magnitude, magenta where negative")
        ->type_name("PNG");
    command->add_option("--plot", arguments->plot, "Write the errors over the number of terms")
        ->type_name("SVG");
    command
        ->add_option("--slice", arguments->slice,
                     "Write lobes in the plane of incidence: the BRDF solid, its terms dashed")
        ->type_name("SVG");
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer("Errors are relative, after each term: Frobenius over the table, RMS of f cos cos over "
                    "80,000 pairs\nof directions (first absolute), reflected radiance as expected under "
                    "environments in general, and\nas measured under the given ones. Terms of factorization "
                    "nonnegative are only good together.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

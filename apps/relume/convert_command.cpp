#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/transport/kept_visibility.h"
#include "precompute/bake/bake_observer.h"
#include "precompute/layout/conversion.h"

#include <memory>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

constexpr double kMostBytes = 1e6; // per vertex

struct Arguments {
    std::filesystem::path input, output;
    std::string layout = layoutName(TransportLayout::Bases);
    std::optional<double> budget, error;
    std::optional<int> coefficients;
    bool quiet = false;
};

LayoutOptions optionsOf(const Arguments& arguments) {
    LayoutOptions options;
    options.layout = layoutFromName(arguments.layout).value();
    if (options.layout == TransportLayout::Rows && (arguments.budget || arguments.error))
        throw UsageError(
            "--layout rows: --budget and --error are for clusters and bases; rows are shortened by "
            "--coefficients");
    if (options.layout != TransportLayout::Rows && arguments.coefficients)
        throw UsageError("--coefficients: shortens rows; clusters and bases have --budget and --error");
    options.coefficients = arguments.coefficients;
    options.bytesPerVertex = arguments.budget;
    options.error = arguments.error.value_or(options.error);
    return options;
}

void checkOutput(const Arguments& arguments) {
    if (arguments.output.extension() != ".relume")
        throw UsageError("--output: expected a name ending in .relume, found \"{}\"",
                         arguments.output.string());
    std::error_code failure;
    if (std::filesystem::equivalent(arguments.input, arguments.output, failure))
        throw UsageError("--output: {} is the bake itself; name another file", arguments.output.string());
    expectWritable(arguments.output);
}

Conversion convert(Asset& asset, const LayoutOptions& options, bool quiet) {
    std::unique_ptr<Progress> progress; // once the work is known
    const auto report = [&](uint64_t done, uint64_t total) {
        if (caughtInterrupt() != 0) throw BakeStopped("stopped");
        if (!progress) progress = std::make_unique<Progress>("converting", total, "vertices", quiet);
        progress->update(done);
    };
    return convertLayout(asset, options, report);
}

// What was asked for may be beyond what a layout can do.
void warnOfMisses(const LayoutOptions& options, const Conversion& conversion, double bytesPerVertex) {
    constexpr double kHardlyMore = 1.05;
    if (options.bytesPerVertex && bytesPerVertex > *options.bytesPerVertex)
        spdlog::warn("a budget of {} bytes a vertex is less than scales alone take; it has {:.0f}",
                     *options.bytesPerVertex, bytesPerVertex);
    if (conversion.error && !options.bytesPerVertex && *conversion.error > kHardlyMore * options.error)
        spdlog::warn(
            "an error of {:.2f} % is beyond this layout's precision; rows of many coefficients keep more",
            100 * options.error);
    if (conversion.error && *conversion.error > 0.5)
        spdlog::warn("more than half of what tells vertices apart is lost; ask for more bytes");
}

void run(const Arguments& arguments) {
    const LayoutOptions options = optionsOf(arguments);
    checkOutput(arguments);
    catchInterrupts();
    try {
        Asset asset = readAsset(arguments.input);
        if (!KeptVisibility(arguments.input).key().empty())
            spdlog::warn("{}: its visibility is not copied; rebake from the file that has it",
                         arguments.input.string());
        const Conversion conversion = convert(asset, options, arguments.quiet);
        if (caughtInterrupt() != 0) throw BakeStopped("stopped");
        writeAsset(arguments.output, asset);
        const double vertices = double(std::max<uint64_t>(1, verticesOf(asset)));
        const auto error =
            conversion.error ? fmt::format(", error {:.2f} %", 100 * *conversion.error) : std::string();
        spdlog::info("{}: {:.1f} MB; transport in {}: {:.0f} bytes a vertex in memory, {:.0f} before{}",
                     arguments.output.string(), double(std::filesystem::file_size(arguments.output)) * 1e-6,
                     arguments.layout, double(conversion.bytesAfter) / vertices,
                     double(conversion.bytesBefore) / vertices, error);
        warnOfMisses(options, conversion, double(conversion.bytesAfter) / vertices);
    } catch (const BakeStopped&) {
        spdlog::warn("stopped; {} is as it was", arguments.output.string());
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

} // namespace

void addConvertCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("convert", "Keep a bake's transport in another layout");
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("FILE", arguments->input, "Bake (.relume)")->required();
    command->add_option("-o,--output", arguments->output, "Bake to write (.relume)")
        ->type_name("FILE")
        ->required();
    std::vector<std::string> names;
    for (size_t i = 0; i < std::variant_size_v<Transport>; i++)
        names.push_back(layoutName(TransportLayout(i)));
    command
        ->add_option("--layout", arguments->layout,
                     "rows: each vertex its own coefficients; clusters: 32 vertices share which; bases: 256 "
                     "vertices share basis vectors, smallest and fastest")
        ->check(CLI::IsMember(names))
        ->type_name("LAYOUT")
        ->capture_default_str();
    CLI::Option* budget =
        command
            ->add_option("--budget", arguments->budget,
                         "Bytes of transport per vertex, in memory, that the least error is "
                         "sought within")
            ->check(between(1, float(kMostBytes)))
            ->type_name("BYTES");
    command
        ->add_option(
            "--error", arguments->error,
            "Error of transport that the fewest bytes are sought for, as light weighs it: 0.05 is 5 %")
        ->check(between(1e-6f, 1))
        ->type_name("ERROR")
        ->default_str(fmt::format("{}", kDefaultLayoutError))
        ->excludes(budget);
    command
        ->add_option("-N,--coefficients", arguments->coefficients,
                     "Most coefficients of a row, in rows; as FILE if it has fewer")
        ->check(CLI::Range(1, 24576))
        ->type_name("COUNT");
    command->add_flag("-q,--quiet", arguments->quiet, "Show no progress");
    command->footer("The error is against FILE's own transport. The more coefficients a bake kept (-N), the\n"
                    "better a layout that is made of it.\n"
                    "relume bake bunny.obj -N 384 -o rows.relume\n"
                    "relume convert rows.relume --layout bases --error 0.03 -o bunny.relume");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

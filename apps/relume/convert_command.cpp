#include "apps/relume/commands.h"
#include "apps/relume/layout_arguments.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/chunk/chunk_file.h"
#include "engine/import/old_asset.h"
#include "engine/transport/kept_visibility.h"
#include "precompute/bake_observer.h"
#include "precompute/layout/conversion.h"
#include "precompute/layout/layout_scale.h"
#include "precompute/residual/residuals.h"

#include <fmt/core.h>
#include <memory>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct ConvertArguments {
    std::filesystem::path input, output;
    LayoutArguments layout;
    std::optional<int> coefficients;
    bool quiet = false;
};

LayoutOptions optionsOf(const ConvertArguments& arguments) {
    const LayoutOptions options = arguments.layout.resolve();
    if (isCompressed(options.layout) && arguments.coefficients)
        throw UsageError("--coefficients: shortens rows; bases have --budget and --error");
    return options;
}

void checkOutput(const ConvertArguments& arguments) {
    expectExtension("--output", arguments.output, ".relume");
    CommandFiles files;
    files.addInput(arguments.input);
    files.addOutput("--output", arguments.output);
    files.check();
    expectWritable(arguments.output);
}

Conversion convert(Asset& asset, const LayoutOptions& options, const ConvertArguments& arguments) {
    std::unique_ptr<Progress> progress; // made once the amount of work is known
    const auto report = [&](uint64_t done, uint64_t total) {
        if (caughtInterrupt() != 0) throw BakeStopped("stopped");
        if (!progress)
            progress = std::make_unique<Progress>("converting", total, "vertices", arguments.quiet);
        progress->update(done);
    };
    return convertLayout(asset, options, report, arguments.coefficients);
}

// Reads a bake of this version or the one before, with residuals.
Asset readInput(const std::filesystem::path& path, std::vector<std::byte> bytes) {
    const std::string name = path.string();
    if (isOldAsset(bytes)) bytes = updateAsset(bytes, name);
    if (!KeptVisibility(sourceOf(bytes), name).key().empty())
        spdlog::warn("{}: its visibility is not copied; rebake from the file that has it", name);
    Asset asset = decodeAsset(bytes, name);
    makeResiduals(asset);
    return asset;
}

void run(const ConvertArguments& arguments) {
    const LayoutOptions options = optionsOf(arguments);
    checkOutput(arguments);
    catchInterrupts();
    try {
        std::vector<std::byte> bytes = readFile(arguments.input);
        const bool isUpdate = isOldAsset(bytes) && !arguments.layout.areGiven() && !arguments.coefficients;
        Asset asset = readInput(arguments.input, std::move(bytes));
        if (isUpdate) {
            writeAsset(arguments.output, asset);
            spdlog::info("{}: updated to format version {}; its transport is as it was",
                         arguments.output.string(), kAssetFormatVersion);
            return;
        }
        const Conversion conversion = convert(asset, options, arguments);
        if (caughtInterrupt() != 0) throw BakeStopped("stopped");
        writeAsset(arguments.output, asset);
        const double vertices = double(std::max<uint64_t>(1, vertexCount(asset)));
        const auto error =
            conversion.error ? fmt::format(", error {:.2f} %", 100 * *conversion.error) : std::string();
        spdlog::info("{}: {:.1f} MB; transport in {}: {:.0f} bytes a vertex in memory, {:.0f} before{}",
                     arguments.output.string(), double(std::filesystem::file_size(arguments.output)) * 1e-6,
                     layoutName(options.layout), double(conversion.bytesAfter) / vertices,
                     double(conversion.bytesBefore) / vertices, error);
        if (conversion.error)
            warnOfMisses(recordOf(options, *conversion.error), double(conversion.bytesAfter) / vertices,
                         LayoutOrigin::Converted);
    } catch (const BakeStopped&) {
        spdlog::warn("stopped; {} is as it was", arguments.output.string());
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

} // namespace

void addConvertCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("convert", "Keep a bake's transport in another layout");
    const auto arguments = std::make_shared<ConvertArguments>();
    command->add_option("FILE", arguments->input, "Bake (.relume)")->required();
    command->add_option("-o,--output", arguments->output, "Bake to write (.relume)")
        ->type_name("FILE")
        ->required();
    arguments->layout.add(*command, true);
    command
        ->add_option("-N,--coefficients", arguments->coefficients,
                     "Most coefficients of a row, in rows; as FILE if it has fewer")
        ->check(CLI::Range(1, 24576))
        ->type_name("COUNT");
    command->add_flag("-q,--quiet", arguments->quiet, "Show no progress");
    command->footer(
        "A file of an earlier program, of format version 2, is updated; without --layout, --budget, --error "
        "and\n"
        "--coefficients its transport stays as it is.\n"
        "The error is against FILE's own transport, in rows of N coefficients; `relume info` adds what FILE\n"
        "had lost already. The more coefficients a bake kept (-N), the better a layout that is made of it.\n"
        "relume bake bunny.obj --layout rows -N 384 -o rows.relume\n"
        "relume convert rows.relume --layout bases --error 0.03 -o bunny.relume");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

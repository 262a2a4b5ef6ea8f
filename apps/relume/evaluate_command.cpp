#include "apps/evaluation/sections.h"
#include "apps/relume/commands.h"
#include "apps/relume/options.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

struct Arguments {
    EvaluationOptions options;
    DeviceArguments device;
};

std::string namesOf(const std::vector<SectionEntry>& entries) {
    std::string text;
    for (const SectionEntry& entry : entries) text += fmt::format("  {:<10} {}\n", entry.name, entry.what);
    return text;
}

void check(const EvaluationOptions& options) {
    if (options.output.empty()) throw UsageError("--output: expected a folder, found nothing");
    std::vector<std::string_view> names;
    for (const SectionEntry& entry : sectionList()) names.emplace_back(entry.name);
    for (const std::string& name : options.only)
        if (std::ranges::find(names, name) == names.end())
            throw UsageError(fmt::format("--only: there is no section \"{}\"; did you mean \"{}\"?", name,
                                         nearestName(name, names)));
    std::error_code failure;
    if (!options.data.empty() && !std::filesystem::is_directory(options.data, failure))
        throw UsageError(fmt::format("--data: {} is no folder", options.data.string()));
}

void run(const Arguments& arguments) {
    const EvaluationOptions& options = arguments.options;
    check(options);
    const std::unique_ptr<vk::Device> device = arguments.device.open();
    Evaluation evaluation(*device, options);
    SceneInputs inputs(options.data, options.quick);
    std::vector<Section> sections;
    for (const SectionEntry& entry : sectionList())
        if (evaluation.isWanted(entry.name)) sections.push_back(entry.make({inputs, options.quick}));
    for (const std::string& line : inputs.missing()) spdlog::warn("{}", line);
    catchInterrupts();
    try {
        const bool isWhole = evaluation.run(sections, inputs);
        spdlog::info("{}", evaluation.reportPath().string());
        DeviceArguments::expectNoMessages(*device);
        if (!isWhole)
            throw Error(
                "some steps failed: the report says which, and why; the same command tries them again");
    } catch (const BakeStopped&) {
        spdlog::warn("stopped; the same command goes on from there");
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

} // namespace

void addEvaluateCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "evaluate", "Measure what the paper measured, and write a report beside its numbers");
    const auto arguments = std::make_shared<Arguments>();
    EvaluationOptions& options = arguments->options;
    command->add_option("-o,--output", options.output, "Folder to write report.html and all else to")
        ->type_name("FOLDER")
        ->required();
    command
        ->add_option(
            "--data", options.data,
            "Folder with meshes/{buddha,dragon,lucy}*.obj and environments/{grace,stpeters,rnl,uffizi}*.hdr; "
            "what is missing is named and skipped")
        ->type_name("FOLDER");
    command->add_flag(
        "--quick", options.quick,
        "In minutes: smaller scenes and images; what is missing is replaced by what is installed; "
        "the report says where");
    command
        ->add_option(
            "--only", options.only,
            "Sections to run, of those below; all if none is named. The report has others that are done, too")
        ->type_name("SECTION…")
        ->delimiter(',');
    arguments->device.add(*command);
    command->footer(
        "Sections:\n" + namesOf(sectionList()) +
        "Results are kept in FOLDER as they are made: after Ctrl-C the same command goes on from there,\n"
        "and a later one does nothing twice. docs/evaluation.md says what is measured.");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume

// The subcommands, one file each, which add themselves to the program.
#pragma once

#include <CLI/CLI.hpp>

namespace relume {

// Throws UsageError if an option of `command` was given before its subcommand, where it has no effect.
void expectNoOptions(const CLI::App& command, const char* subcommand);

void addBakeCommand(CLI::App& program);
void addMergeCommand(CLI::App& program);
void addConvertCommand(CLI::App& program);
void addRebakeCommand(CLI::App& program);
void addRenderCommand(CLI::App& program);
void addReferenceCommand(CLI::App& program);
void addCompareCommand(CLI::App& program);
void addVerifyCommand(CLI::App& program);
void addErrorsCommand(CLI::App& program);
void addSheetCommand(CLI::App& program);
void addInfoCommand(CLI::App& program);
void addAdviseCommand(CLI::App& program);
void addMaterialsCommand(CLI::App& program);
void addBrdfCommand(CLI::App& program);
void addDevicesCommand(CLI::App& program);
void addBenchCommand(CLI::App& program);
void addBenchBakeCommand(CLI::App& bench);
void addBenchRelightCommand(CLI::App& bench);
void addBenchViewCommand(CLI::App& bench);

} // namespace relume

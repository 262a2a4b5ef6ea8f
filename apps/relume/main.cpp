#include "apps/relume/commands.h"
#include "apps/relume/help_formatter.h"
#include "apps/relume/run_program.h"

using namespace relume;

int main(int argc, char** argv) {
    startProgram("relume");

    CLI::App program{"Relights glossy objects in real time from transport baked once per vertex.", "relume"};
    program.set_version_flag("--version", "relume " RELUME_VERSION);
    program.require_subcommand(1);
    program.formatter(std::make_shared<HelpFormatter>());
    program.footer(
        "Try: relume bake -o knot.relume && relume render knot.relume -o knot.png\n"
        "`relume COMMAND --help` explains each command.\n"
        "Exit codes: 0 done, 1 failed, 2 usage, 3 comparison over its threshold, 4 no usable device,\n"
        "130 stopped by Ctrl-C, 143 stopped by SIGTERM.");
    addBakeCommand(program);
    addMergeCommand(program);
    addRebakeCommand(program);
    addConvertCommand(program);
    addRenderCommand(program);
    addSheetCommand(program);
    addReferenceCommand(program);
    addCompareCommand(program);
    addVerifyCommand(program);
    addAdviseCommand(program);
    addErrorsCommand(program);
    addInfoCommand(program);
    addMaterialsCommand(program);
    addBrdfCommand(program);
    addDevicesCommand(program);
    addBenchCommand(program);
    return runProgram(program, argc, argv, [] {});
}

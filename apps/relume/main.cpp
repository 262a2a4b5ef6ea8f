#include "apps/relume/commands.h"
#include "engine/base/error.h"

#include <cstdio>
#include <iostream>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

using namespace relume;

namespace {

// Parses, runs the subcommand through its callback; CLI11's many exit codes become ours.
int run(CLI::App& program, int argc, char** argv) {
    try {
        program.parse(argc, argv);
        std::cout.flush();
        if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout))
            throw Error("standard output: cannot be written; is its disk full, or its reader gone?");
        return kExitDone;
    } catch (const CLI::Success& success) { // --help, --version
        return program.exit(success);
    } catch (const CLI::RuntimeError& decided) {
        return decided.get_exit_code();
    } catch (const CLI::ParseError& wrong) {
        program.exit(wrong);
        return kExitUsage;
    } catch (const UsageError& wrong) {
        spdlog::error("{}", wrong.what());
        return kExitUsage;
    } catch (const NoDeviceError& none) {
        spdlog::error("{}", none.what());
        return kExitNoDevice;
    } catch (const std::bad_alloc&) {
        spdlog::error("out of memory");
        return kExitFailed;
    } catch (const std::exception& failure) {
        spdlog::error("{}", failure.what());
        return kExitFailed;
    }
}

} // namespace

int main(int argc, char** argv) {
    // Data goes to stdout, words for people to stderr.
    spdlog::set_default_logger(spdlog::stderr_color_mt("relume"));
    spdlog::set_pattern("%^%l%$: %v");

    CLI::App program{"Relights glossy objects in real time from transport baked once per vertex.", "relume"};
    program.set_version_flag("--version", "relume " RELUME_VERSION);
    program.require_subcommand(1);
    program.get_formatter()->column_width(34);
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
    addReferenceCommand(program);
    addCompareCommand(program);
    addVerifyCommand(program);
    addInfoCommand(program);
    addMaterialsCommand(program);
    addBrdfCommand(program);
    addDevicesCommand(program);
    addBenchCommand(program);
    return run(program, argc, argv);
}

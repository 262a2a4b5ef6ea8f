#include "apps/relume/help_formatter.h"
#include "apps/relume/options.h"
#include "apps/relume/run_program.h"
#include "apps/viewer/viewer.h"
#include "apps/viewer/window.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"

#include <fmt/core.h>

using namespace relume;

int main(int argc, char** argv) {
    startProgram("relume-viewer");

    CLI::App program{"Shows bakes and meshes under any distant light, live.", "relume-viewer"};
    program.set_version_flag("--version", "relume-viewer " RELUME_VERSION);
    program.formatter(std::make_shared<HelpFormatter>());
    ViewerOptions options;
    program.add_option(
        "FILE", options.files,
        "Bakes (.relume); meshes and scenes, which are baked in view; environments, lights and "
        "sessions (.exr, .hdr, .json). Default: a built-in scene");
    std::string size;
    program.add_option("--size", size, "Window size (default: as the last time, or 1280x720)")
        ->type_name("WxH")
        ->each([&options](const std::string& text) {
            ivec2 found(0);
            char rest;
            if (std::sscanf(text.c_str(), "%dx%d%c", &found.x, &found.y, &rest) != 2 ||
                found.x < kSmallestWindow.x || found.y < kSmallestWindow.y || found.x > kLargestWindow ||
                found.y > kLargestWindow)
                throw UsageError(
                    fmt::format("--size: expected WIDTHxHEIGHT, from {}x{} to {}x{}, found \"{}\"",
                                kSmallestWindow.x, kSmallestWindow.y, kLargestWindow, kLargestWindow, text));
            options.size = found;
        });
    program.add_flag_callback(
        "--no-vsync", [&options] { options.waitsForDisplay = false; },
        "Show frames as soon as they are drawn");
    program.add_option("--script", options.script, "Replay inputs and settings (.json): docs/viewer.md")
        ->type_name("FILE");
    CLI::Option* const exitFrame =
        program.add_option("--exit-frame", options.exitFrame, "End after so many frames of what was opened")
            ->type_name("N")
            ->check(CLI::Range(1, 1000000000));
    program
        .add_option("--screenshot", options.screenshot,
                    "Write the last of these: .png as it is seen, .exr linear without panels")
        ->type_name("IMAGE")
        ->needs(exitFrame);
    program
        .add_option("--timings", options.timings,
                    "Write what each frame spends its time on: .json for trace viewers, .csv a table")
        ->type_name("FILE");
    DeviceArguments device;
    device.add(program);
    program.footer("H shows all keys. Exit codes: 0 done, 1 failed, 2 usage, 4 no usable device or display, "
                   "130 and 143 stopped by Ctrl-C and SIGTERM.");
    return runProgram(program, argc, argv, [&] {
        const std::string image = options.screenshot.extension();
        if (!options.screenshot.empty() && image != ".png" && image != ".exr")
            throw UsageError(fmt::format("--screenshot: expected a name ending in .png or .exr, found \"{}\"",
                                         options.screenshot.string()));
        options.device = device.options;
        runViewer(options);
        if (caughtInterrupt()) throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    });
}

#include "apps/relume/options.h"
#include "apps/viewer/viewer.h"
#include "engine/base/error.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

using namespace relume;

namespace {

int run(CLI::App& program, int argc, char** argv, const ViewerOptions& options) {
    try {
        program.parse(argc, argv);
        runViewer(options);
        return kExitDone;
    } catch (const CLI::Success& success) { // --help, --version
        return program.exit(success);
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
    spdlog::set_default_logger(spdlog::stderr_color_mt("relume-viewer"));
    spdlog::set_pattern("%^%l%$: %v");

    CLI::App program{"Shows bakes and meshes under any distant light, live.", "relume-viewer"};
    program.set_version_flag("--version", "relume-viewer " RELUME_VERSION);
    program.get_formatter()->column_width(34);
    ViewerOptions options;
    program.add_option("FILE", options.files,
                       "Bakes (.relume); meshes and scenes, which are baked in view; environments and lights "
                       "(.exr, .hdr, .json). Default: a built-in scene");
    std::string size;
    program
        .add_option("--size", size, fmt::format("Window size (default {}x{})", options.width, options.height))
        ->type_name("WxH")
        ->each([&options](const std::string& text) {
            char rest;
            if (std::sscanf(text.c_str(), "%dx%d%c", &options.width, &options.height, &rest) != 2 ||
                options.width < 320 || options.height < 240 || options.width > 16384 ||
                options.height > 16384)
                throw UsageError("--size: expected WIDTHxHEIGHT, from 320x240 to 16384x16384, found \"{}\"",
                                 text);
        });
    program.add_flag("!--no-vsync", options.waitsForDisplay, "Show frames as soon as they are drawn");
    program.add_option("--script", options.script, "Replay inputs and settings (.json): docs/viewer.md")
        ->type_name("FILE");
    program.add_option("--exit-frame", options.exitFrame, "End after so many frames")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000000));
    program
        .add_option("--screenshot", options.screenshot,
                    "Write the last frame at the end: .png as it is seen, .exr linear without panels")
        ->type_name("IMAGE");
    program
        .add_option("--timings", options.timings,
                    "Write what each frame spends its time on: .json for trace viewers, .csv a table")
        ->type_name("FILE");
    DeviceArguments device;
    device.add(program);
    program.footer("H shows all keys. Exit codes: 0 done, 1 failed, 2 usage, 4 no usable device or display.");
    program.final_callback([&] { options.device = device.options; });
    return run(program, argc, argv, options);
}

#include "apps/relume/run_program.h"

#include "engine/base/error.h"
#include "engine/base/log.h"

#include <cstdio>
#include <iostream>
#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

// Software drivers allocate what they need for a frame and free it afterwards. As glibc would have it the
// system gets it back between the frames, and finding it again costs as much as processing the vertices
// (docs/view_speed.md).
void keepFreedMemory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20); // what it would grow to by itself, had the other not been set
#endif
}

} // namespace

void logToStderr(const char* name) {
    spdlog::set_default_logger(spdlog::stderr_color_mt(name));
    spdlog::set_pattern("%^%l%$: %v");
    setLog([](LogLevel level, const std::string& text) {
        constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::debug, spdlog::level::info,
                                                         spdlog::level::warn, spdlog::level::err};
        spdlog::log(kLevels[size_t(level)], "{}", text);
    });
}

int runProgram(CLI::App& program, int argc, char** argv, const std::function<void()>& work) {
    keepFreedMemory();
    try {
        program.parse(argc, argv);
        work();
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

} // namespace relume

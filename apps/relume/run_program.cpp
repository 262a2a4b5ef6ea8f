#include "apps/relume/run_program.h"

#include "engine/base/error.h"
#include "engine/base/error_message.h"
#include "engine/base/log.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fmt/core.h>
#include <iostream>
#include <malloc.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

// Keeps freed memory in the process. Software drivers allocate memory for a frame and free it afterwards. By
// default glibc returns it to the system between frames, and getting it back costs as much as processing the
// vertices (docs/view_speed.md).
void keepFreedMemory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20); // the value it would grow to by itself if the other were not set
#endif
}

// Ends the program where an exception leaves what must not throw.
[[noreturn]] void endAtException() {
    try {
        if (const std::exception_ptr cause = std::current_exception()) std::rethrow_exception(cause);
    } catch (const std::bad_alloc& failure) {
        std::fprintf(stderr, "error: %s\n", errorMessage(failure));
        std::_Exit(kExitFailed);
    } catch (const std::exception& bug) {
        std::fprintf(stderr, "error: unexpected: %s\n", bug.what());
    } catch (...) {
    }
    std::abort();
}

constexpr const char* kUnwritten =
    "standard output: cannot be written; is its disk full, or its reader gone?";

// Throws for an empty argument, which options would take for none; most likely a shell variable is not set.
void checkArguments(int argc, char** argv) {
    for (int i = 1; i < argc; i++) {
        const std::string_view argument = argv[i];
        const size_t assigned = argument.find('=');
        if (argument.empty() || (argument.starts_with("--") && assigned == argument.size() - 1))
            throw UsageError(fmt::format("{}: expected a value, found an empty text; is a variable not set?",
                                         argument.empty() ? argv[i - 1] : argument.substr(0, assigned)));
    }
}

// Throws if the program has commands and the first word is none of them.
void checkCommand(const CLI::App& program, char** argv) {
    const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty() || !argv[1] || *argv[1] == '-') return;
    std::vector<std::string> owned;
    for (const CLI::App* command : commands) owned.push_back(command->get_name());
    if (std::ranges::find(owned, argv[1]) != owned.end()) return;
    const std::vector<std::string_view> names(owned.begin(), owned.end());
    throw UsageError(fmt::format("{}: no such command; did you mean {}? `{} --help` lists all", argv[1],
                                 nearestName(argv[1], names), program.get_name()));
}

// Prints a message with control characters escaped, since it may contain names from files.
class PrintableText : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
        const std::string text = printable({message.payload.data(), message.payload.size()});
        out.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<PrintableText>();
    }
};

} // namespace

void startProgram(const char* name) {
    std::set_terminate(endAtException);
    spdlog::set_default_logger(spdlog::stderr_color_mt(name));
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<PrintableText>('*').set_pattern("%^%l%$: %*");
    spdlog::set_formatter(std::move(formatter));
    setLog([](LogLevel level, const std::string& text) {
        constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::debug, spdlog::level::info,
                                                         spdlog::level::warn, spdlog::level::err};
        spdlog::log(kLevels[size_t(level)], "{}", text);
    });
}

int runProgram(CLI::App& program, int argc, char** argv, const std::function<void()>& work) {
    keepFreedMemory();
    try {
        checkArguments(argc, argv);
        if (argc < 2 && program.get_require_subcommand_min() > 0) {
            std::cerr << program.help();
            return kExitUsage;
        }
        checkCommand(program, argv);
        try {
            program.parse(argc, argv);
            work();
        } catch (const CLI::Success& success) { // --help, --version
            program.exit(success);
        }
        std::cout.flush();
        if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout)) throw Error(kUnwritten);
        return kExitDone;
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
    } catch (const std::exception& failure) {
        spdlog::error("{}", std::ferror(stdout) ? kUnwritten : errorMessage(failure));
        return kExitFailed;
    }
}

} // namespace relume

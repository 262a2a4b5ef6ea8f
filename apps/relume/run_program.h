// Runs a program's work with its command line, messages and exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace relume {

// Sends log messages to stderr, after level and the program's `name`. stdout is for data.
void logToStderr(const char* name);

// Parses the command line, runs its callbacks, then `work`. Exceptions become messages on stderr and an exit
// code (engine/base/error.h).
int runProgram(CLI::App& program, int argc, char** argv, const std::function<void()>& work);

} // namespace relume

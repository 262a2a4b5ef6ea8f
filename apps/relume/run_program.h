// Runs a program's work with its command line, messages and exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace relume {

// To be called first. Sends log messages to stderr, after level and the program's `name`; stdout is for data.
// Memory that runs out where no exception can be caught, as in a destructor, ends the program with a message
// and exit code 1.
void startProgram(const char* name);

// Parses the command line, runs its callbacks, then `work`. Exceptions become messages on stderr and an exit
// code (engine/base/error.h).
int runProgram(CLI::App& program, int argc, char** argv, const std::function<void()>& work);

} // namespace relume

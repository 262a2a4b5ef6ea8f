// What every program does around its work.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace relume {

// Words for people go to stderr, after their level; `name` is the program's. Data is stdout's.
void logToStderr(const char* name);

// Parses the command line, runs what it calls back, then `work`; what fails becomes words on stderr and an
// exit code (engine/base/error.h).
int runProgram(CLI::App& program, int argc, char** argv, const std::function<void()>& work);

} // namespace relume

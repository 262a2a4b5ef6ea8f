// Failures of input or environment. The text says which file, what was expected, what was found and
// what to do. Thrown where found, caught in main only, where the type decides the exit code.
#pragma once

#include "engine/base/printable.h"

#include <stdexcept>

namespace relume {

// Exit codes of every program: documented in README.md.
enum ExitCode : int {
    kExitDone = 0,
    kExitFailed = 1,
    kExitUsage = 2,
    kExitOverThreshold = 3,
    kExitNoDevice = 4,
    kExitStopped = 128, // + the signal's number
};

// Bad input or a failing environment: exit code 1.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& text) : std::runtime_error(printable(text)) {}
};

// Options that cannot be used as given: exit code 2.
class UsageError : public Error {
  public:
    using Error::Error;
};

// No Vulkan device that will do: exit code 4.
class NoDeviceError : public Error {
  public:
    using Error::Error;
};

} // namespace relume

// Errors for bad input or a failing environment. Their text says which file, what was expected, what was
// found and what to do. They are caught in main only, where the type decides the exit code.
#pragma once

#include "engine/base/printable.h"

#include <stdexcept>

namespace relume {

// Exit codes of every program, documented in README.md.
enum ExitCode : int {
    kExitDone = 0,
    kExitFailed = 1,
    kExitUsage = 2,
    kExitOverThreshold = 3,
    kExitNoDevice = 4,
    kExitStopped = 128, // + the signal's number
};

// An error of input or environment: exit code 1.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& text) : std::runtime_error(printable(text)) {}
};

// Thrown when options cannot be used as given: exit code 2.
class UsageError : public Error {
  public:
    using Error::Error;
};

// Thrown when no Vulkan device is suitable: exit code 4.
class NoDeviceError : public Error {
  public:
    using Error::Error;
};

} // namespace relume

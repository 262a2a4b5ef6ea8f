// Reads sessions saved by the viewer (docs/session_format.md).
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>

namespace relume {

// Sets options of `command` from a session file, unless they, or options that exclude them, were given as
// well. Throws Error naming file and key.
void applySession(const std::filesystem::path& file, CLI::App& command);

} // namespace relume

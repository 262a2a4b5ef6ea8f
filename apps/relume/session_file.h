// Sessions that the viewer saves: docs/session_format.md.
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>

namespace relume {

// Gives options of `command` the values that a session file has for them, unless they, or options that they
// exclude, were given beside it. Throws Error that names file and key.
void applySession(const std::filesystem::path& file, CLI::App& command);

} // namespace relume

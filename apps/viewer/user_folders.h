// The folders of a user's files by the XDG Base Directory specification.
#pragma once

#include <filesystem>

namespace relume {

// Returns the folder for files that can be recreated, $XDG_CACHE_HOME/relume or ~/.cache/relume, after making
// it. Throws Error if it cannot be made.
std::filesystem::path cacheFolder();

// Returns the folder for what programs remember, $XDG_STATE_HOME/relume or ~/.local/state/relume, likewise.
std::filesystem::path stateFolder();

} // namespace relume

// Where a user's files are, by the XDG Base Directory specification.
#pragma once

#include <filesystem>

namespace relume {

// What can be made again: $XDG_CACHE_HOME/relume, else ~/.cache/relume. Made if it is not there; throws Error
// where it cannot be.
std::filesystem::path cacheFolder();

// What a program remembers: $XDG_STATE_HOME/relume, else ~/.local/state/relume. Likewise.
std::filesystem::path stateFolder();

} // namespace relume

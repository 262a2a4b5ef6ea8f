#include "apps/viewer/user_folders.h"

#include "engine/base/error.h"

#include <cstdlib>
#include <fmt/core.h>

namespace relume {

namespace {

std::filesystem::path folder(const char* variable, const char* inHome) {
    std::filesystem::path base = std::filesystem::temp_directory_path();
    if (const char* home = std::getenv("HOME"); home && *home) base = std::filesystem::path(home) / inHome;
    // The specification: "If an implementation encounters a relative path […] it should […] ignore it."
    if (const char* set = std::getenv(variable); set && *set == '/') base = set;
    std::error_code failure;
    std::filesystem::create_directories(base / "relume", failure);
    if (failure)
        throw Error(fmt::format("{}: cannot be made: {}; {} names another place for it",
                                (base / "relume").string(), failure.message(), variable));
    return base / "relume";
}

} // namespace

std::filesystem::path cacheFolder() { return folder("XDG_CACHE_HOME", ".cache"); }

std::filesystem::path stateFolder() { return folder("XDG_STATE_HOME", ".local/state"); }

} // namespace relume

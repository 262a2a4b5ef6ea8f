#include "apps/evaluation/evaluation_folder.h"

#include "engine/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace relume {

void makeFolder(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    // A link to a folder counts as a failure to create_directories(), but not here.
    std::error_code unknown;
    if (failure && !std::filesystem::is_directory(folder, unknown))
        throw Error(fmt::format("{}: the folder cannot be made: {}", folder.string(), failure.message()));
}

FolderLock::FolderLock(const std::filesystem::path& folder) {
    makeFolder(folder);
    mFolder = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (mFolder < 0)
        throw Error(
            fmt::format("{}: the folder cannot be opened: {}", folder.string(), std::strerror(errno)));
    if (flock(mFolder, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(mFolder);
        throw Error(fmt::format(
            "{}: another evaluation is writing to this folder; wait for it, stop it, or name another "
            "folder",
            folder.string()));
    }
}

FolderLock::~FolderLock() { close(mFolder); }

} // namespace relume

#include "engine/base/read_files.h"

#include "engine/base/check.h"

#include <mutex>

namespace relume {

namespace {

std::mutex gMutex; // guards gCollector and the paths that it collects
ReadFiles* gCollector = nullptr;

} // namespace

ReadFiles::ReadFiles() {
    const std::scoped_lock lock(gMutex);
    RELUME_CHECK(!gCollector);
    gCollector = this;
}

ReadFiles::~ReadFiles() {
    const std::scoped_lock lock(gMutex);
    gCollector = nullptr;
}

std::set<std::filesystem::path> ReadFiles::paths() const {
    const std::scoped_lock lock(gMutex);
    return mPaths;
}

void ReadFiles::add(const std::filesystem::path& path) {
    const std::scoped_lock lock(gMutex);
    if (gCollector) gCollector->mPaths.insert(path);
}

} // namespace relume

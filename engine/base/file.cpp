#include "engine/base/file.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <mutex>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace relume {

namespace {

std::mutex gMutex; // guards gCollector and the paths that it collects
ReadFiles* gCollector = nullptr;

} // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, size_t limit) {
    ReadFiles::add(path);
    std::error_code failure;
    const auto status = std::filesystem::status(path, failure);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(
            fmt::format("{}: expected a regular file, found a folder, pipe or device", path.string()));
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    const std::streamoff size = file.tellg();
    if (size < 0) throw Error(fmt::format("{}: expected a regular file", path.string()));
    if (size_t(size) > limit)
        throw Error(fmt::format("{}: holds {} bytes, more than the {} that such a file may have",
                                path.string(), size, limit));
    std::vector<std::byte> bytes(size_t(size), std::byte(0));
    file.seekg(0);
    if (!bytes.empty() && !file.read(reinterpret_cast<char*>(bytes.data()), size))
        throw Error(fmt::format("{}: cannot be read to its end", path.string()));
    return bytes;
}

FileReader::FileReader(std::filesystem::path path) : mPath(std::move(path)) {
    ReadFiles::add(mPath);
    mDescriptor = open(mPath.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (mDescriptor < 0)
        throw Error(fmt::format("{}: cannot be read: {}", mPath.string(), std::strerror(errno)));
    struct stat status {};
    if (fstat(mDescriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(mDescriptor);
        throw Error(
            fmt::format("{}: expected a regular file, found a folder, pipe or device", mPath.string()));
    }
    mSize = uint64_t(status.st_size);
}

FileReader::~FileReader() { close(mDescriptor); }

void FileReader::read(uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = pread(mDescriptor, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0)
            throw Error(fmt::format("{}: cannot be read: {}", mPath.string(), std::strerror(errno)));
        if (count == 0) throw Error(fmt::format("{}: became shorter while it was read", mPath.string()));
        offset += uint64_t(count);
        bytes = bytes.subspan(size_t(count));
    }
}

// Returns the message for a file on which a call has just failed; the reason is in errno.
static std::string unwritten(const std::filesystem::path& path) {
    return fmt::format("{}: cannot be written: {}; make room, or name a file elsewhere", path.string(),
                       std::strerror(errno));
}

// Returns the file that writing `path` replaces: a symbolic link's target, else `path`. Throws if it is not a
// regular file.
static std::filesystem::path replacedFile(std::filesystem::path path) {
    std::error_code failure;
    const auto status = std::filesystem::status(path, failure);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(fmt::format("{}: cannot be written: it is a folder, pipe or device; name a regular file",
                                path.string()));
    if (std::filesystem::is_symlink(path, failure)) return std::filesystem::weakly_canonical(path);
    return path;
}

static std::filesystem::path folderOf(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : ".";
}

AtomicFile::AtomicFile(std::filesystem::path path) : mPath(replacedFile(std::move(path))) {
    // mkstemp() would make a private file. To give it the permissions of any new file takes the process's
    // umask, which cannot be read without changing it for other threads.
    constexpr int kMostTries = 100;
    std::random_device random;
    for (int tries = 0; mDescriptor < 0; tries++) {
        mTemporary = fmt::format("{}.{:08x}", mPath.string(), random());
        mDescriptor = open(mTemporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (mDescriptor < 0 && (errno != EEXIST || tries == kMostTries))
            throw Error(fmt::format("{}: cannot be written: {}; is its folder there and writable?",
                                    mPath.string(), std::strerror(errno)));
    }
}

AtomicFile::AtomicFile(std::filesystem::path path, const std::string& suffix)
    : mPath(replacedFile(std::move(path))) {
    mTemporary = mPath.string() + suffix;
    mDescriptor = open(mTemporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (mDescriptor < 0)
        throw Error(fmt::format("{}: cannot be written: {}; is its folder there and writable?",
                                mTemporary.string(), std::strerror(errno)));
}

AtomicFile::~AtomicFile() {
    if (mDescriptor < 0) return;
    close(mDescriptor);
    unlink(mTemporary.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(mDescriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) throw Error(unwritten(mPath));
        bytes = bytes.subspan(size_t(written));
    }
}

void AtomicFile::commit() {
    // A library may have replaced the temporary file, so flush whichever file has its name now.
    const int current = open(mTemporary.c_str(), O_RDONLY);
    const bool flushed = current >= 0 && fsync(current) == 0;
    if (current >= 0) close(current);
    if (!flushed || rename(mTemporary.c_str(), mPath.c_str()) != 0) throw Error(unwritten(mPath));
    close(mDescriptor);
    mDescriptor = -1;
    // A new name survives a crash of the machine only once its folder has been flushed.
    const int directory = open(folderOf(mPath).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return;
    (void)fsync(directory);
    close(directory);
}

void expectWritable(const std::filesystem::path& path) {
    // An unnamed temporary file leaves nothing behind even if the process is killed now. Not every file
    // system supports one.
    const int probe = open(folderOf(replacedFile(path)).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (probe >= 0)
        close(probe);
    else
        const AtomicFile named(path);
}

void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

void writeFileAtomically(const std::filesystem::path& path, const std::string& text) {
    writeFileAtomically(path, std::as_bytes(std::span(text)));
}

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

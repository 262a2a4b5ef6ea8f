// Whole-file reads and atomic writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace relume {

// Returns the whole file. Throws Error when it cannot be read, or is larger than `limit` bytes.
std::vector<std::byte> readFile(const std::filesystem::path& path, size_t limit = size_t(64) << 30);

// A regular file that is read piece by piece.
class FileReader {
  public:
    // Throws Error when it cannot be opened, or is something else than a regular file.
    explicit FileReader(std::filesystem::path path);
    ~FileReader();
    FileReader(const FileReader&) = delete;
    FileReader& operator=(const FileReader&) = delete;

    uint64_t size() const { return mSize; }
    const std::filesystem::path& path() const { return mPath; }

    // Fills `bytes` from `offset` on. Throws Error when the file has become shorter, or cannot be read.
    void read(uint64_t offset, std::span<std::byte> bytes) const;

  private:
    std::filesystem::path mPath;
    int mDescriptor = -1;
    uint64_t mSize = 0;
};

// A file that appears whole or not at all: bytes go to a temporary file beside `path`, which replaces
// `path` only in commit(). Destroyed before commit(), it leaves `path` as it was.
class AtomicFile {
  public:
    // Creates the temporary file, beside the file that a symbolic link leads to. Throws Error when the folder
    // cannot be written, or `path` is something else than a regular file (a device, a folder).
    explicit AtomicFile(std::filesystem::path path);
    // The same with a temporary file of a name of its own, `path` + `suffix`, so that one left behind by a
    // killed process is used again. The caller keeps others from writing the same file.
    AtomicFile(std::filesystem::path path, const std::string& suffix);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Where a library that writes by file name must write.
    const std::filesystem::path& temporaryPath() const { return mTemporary; }

    // Appends bytes. Throws Error on failure (a full disk, say).
    void write(std::span<const std::byte> bytes);

    // Flushes to the disk, renames over the final path. Throws Error on failure.
    void commit();

  private:
    std::filesystem::path mPath;
    std::filesystem::path mTemporary;
    int mDescriptor = -1;
};

// Throws Error, before long work, if an AtomicFile could not be made for `path`. Leaves nothing behind.
void expectWritable(const std::filesystem::path& path);

// Writes `bytes` to `path`, whole or not at all.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& path, const std::string& text);

} // namespace relume

// Reading of files, whole or piece by piece, atomic writing, and a record of what was read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace relume {

// Returns the whole file. Throws Error if it cannot be read, or is larger than `limit` bytes.
std::vector<std::byte> readFile(const std::filesystem::path& path, size_t limit = size_t(64) << 30);

// A regular file, open to be read piece by piece.
class FileReader {
  public:
    // Opens the file. Throws Error if it cannot be opened or is not a regular file.
    explicit FileReader(std::filesystem::path path);
    ~FileReader();
    FileReader(const FileReader&) = delete;
    FileReader& operator=(const FileReader&) = delete;

    uint64_t size() const { return mSize; }
    const std::filesystem::path& path() const { return mPath; }

    // Fills `bytes` from `offset` on. Throws Error if the file has become shorter or cannot be read.
    void read(uint64_t offset, std::span<std::byte> bytes) const;

  private:
    std::filesystem::path mPath;
    int mDescriptor = -1;
    uint64_t mSize = 0;
};

// A file that appears whole or not at all. Bytes go to a temporary file beside `path`, which commit() renames
// to `path`. If it is destroyed before commit(), `path` stays as it was.
class AtomicFile {
  public:
    // Creates the temporary file, beside the target if `path` is a symbolic link. Throws Error if the folder
    // cannot be written or `path` exists and is not a regular file (a device, a folder).
    explicit AtomicFile(std::filesystem::path path);
    // Creates a temporary file with a fixed name, `path` + `suffix`, so that one left behind by a killed
    // process is used again. The caller must keep other processes from writing the same file.
    AtomicFile(std::filesystem::path path, const std::string& suffix);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Appends bytes. Throws Error on failure, such as a full disk.
    void write(std::span<const std::byte> bytes);

    // Flushes to the disk and renames the temporary file to `path`. Throws Error on failure.
    void commit();

  private:
    std::filesystem::path mPath;
    std::filesystem::path mTemporary;
    int mDescriptor = -1;
};

// Throws Error if no AtomicFile can be made for `path`: call it before long work. Leaves nothing behind.
void expectWritable(const std::filesystem::path& path);

// Writes to `path`, whole or not at all. Throws Error on failure.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& path, const std::string& text);

// A record of the files that a process reads, kept so that it does not overwrite them. Collects the names of
// files that readFile() and FileReader open during its lifetime, on any thread. Only one may exist at a time.
class ReadFiles {
  public:
    ReadFiles();
    ~ReadFiles();
    ReadFiles(const ReadFiles&) = delete;
    ReadFiles& operator=(const ReadFiles&) = delete;

    std::set<std::filesystem::path> paths() const;

    static void add(const std::filesystem::path& path); // does nothing if there is no collector

  private:
    std::set<std::filesystem::path> mPaths;
};

} // namespace relume

// The container of a .relume file: a checked header, a table, and compressed chunks of bytes.
// docs/asset_format.md describes every byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace relume {

constexpr uint32_t kAssetFormatVersion = 3;

// The type of a chunk, four letters. A reader that does not know a tag refuses the file if the first letter
// is a capital, and skips the chunk otherwise.
using ChunkTag = std::array<char, 4>;
constexpr ChunkTag chunkTag(const char (&text)[5]) { return {text[0], text[1], text[2], text[3]}; }
constexpr bool isRequired(ChunkTag tag) { return tag[0] >= 'A' && tag[0] <= 'Z'; }
std::string tagText(ChunkTag tag); // for messages: anything but letters and digits becomes '?'

// The owner of chunks that belong to the file as a whole.
constexpr uint32_t kWholeFile = 0xffffffff;

// Limits on what a reader must hold and on what a small file can make it allocate.
constexpr size_t kLargestChunk = size_t(8) << 20; // bytes before compression
constexpr uint64_t kLargestRatio = 1024;          // raw size ≤ kLargestRatio · stored size + kRatioSlack
constexpr uint64_t kRatioSlack = 65536;

// An entry of the chunk table. A long array is cut into chunks of the same tag and owner: run 0, 1, 2, ….
struct ChunkEntry {
    ChunkTag tag{};
    uint32_t owner = kWholeFile; // a part, or a set of materials, counted over all parts
    uint32_t run = 0;
    uint64_t offset = 0; // from the start of the file
    uint64_t storedSize = 0;
    uint64_t rawSize = 0; // equal to storedSize: stored uncompressed; else one zstd frame
    uint64_t checksum = 0;
};

// A chunk as it is stored in a file. The offset of its entry is not yet set.
struct StoredChunk {
    ChunkEntry entry;
    std::vector<std::byte> bytes;
};

// Compresses 1 to kLargestChunk bytes; stores them as they are if that is no longer.
StoredChunk storeChunk(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw);

// Collects chunks in file order, compressing each as it is added, and writes the file.
class ChunkWriter {
  public:
    // Returns the stored bytes of a chunk that is kept elsewhere.
    using Load = std::function<std::vector<std::byte>()>;
    // Takes the next bytes of the file.
    using Output = std::function<void(std::span<const std::byte>)>;

    void add(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw);
    // Adds a chunk that is already stored. finish() calls `load` once, when the chunk's turn comes, so that
    // no two such chunks are in memory at a time.
    void addStored(const ChunkEntry& entry, Load load);

    // Write the whole file: header, table, chunks.
    void finish(const Output& output);
    std::vector<std::byte> finish();

  private:
    struct Piece {
        ChunkEntry entry; // without `load`, its offset is one into mData
        Load load;
    };
    std::vector<Piece> mPieces;
    std::vector<std::byte> mData;
};

// Random access to the bytes of a file, in memory or elsewhere.
struct ByteSource {
    uint64_t size = 0;
    // Returns `count` bytes from `offset` on, a range within `size`. Bytes that are not in memory yet are
    // read into `room`, which must then outlive the result.
    std::function<std::span<const std::byte>(uint64_t offset, size_t count, std::vector<std::byte>& room)>
        read;
};
ByteSource sourceOf(std::span<const std::byte> bytes); // `bytes` must outlive it

// Returns the decompressed contents of a stored chunk. Throws Error; `name` names the file in it.
std::vector<std::byte> unpackChunk(const ChunkEntry& entry, std::span<const std::byte> stored,
                                   const std::string& name);

// Returns whether the bytes begin as a .relume file of any version does.
bool hasAssetMagic(std::span<const std::byte> bytes);

// Reads a .relume file chunk by chunk, after checking it.
class ChunkFile {
  public:
    // Checks all but the chunks' decompressed contents: magic, version, checksums, sizes, limits, that no run
    // is there twice. Holds the table and one chunk at a time. `name` names the file in errors. Throws Error.
    ChunkFile(ByteSource source, std::string name, uint32_t version = kAssetFormatVersion);
    ChunkFile(std::span<const std::byte> bytes, std::string name) // `bytes` must outlive it
        : ChunkFile(sourceOf(bytes), std::move(name)) {}

    // Returns all chunks in file order.
    const std::vector<ChunkEntry>& entries() const { return mEntries; }

    // Returns the runs of an array in order; none if it is empty. Throws Error if a run is missing.
    std::vector<ChunkEntry> find(ChunkTag tag, uint32_t owner) const;

    // Returns a single run, whether or not others are there; null if it is missing.
    const ChunkEntry* findRun(ChunkTag tag, uint32_t owner, uint32_t run) const;

    // Returns the decompressed bytes of a chunk. Throws Error.
    std::vector<std::byte> load(const ChunkEntry& entry) const;

    // Returns the bytes of a chunk as stored. Checks their checksum again, because a file on disk may have
    // changed. Throws Error.
    std::vector<std::byte> loadStored(const ChunkEntry& entry) const;

    const std::string& name() const { return mName; }

  private:
    void readTable(uint32_t version);
    void checkEntry(const ChunkEntry& entry, uint64_t expectedOffset, std::vector<std::byte>& room) const;
    void expectChecksum(const ChunkEntry& entry, std::span<const std::byte> stored) const;

    ByteSource mSource;
    std::string mName;
    std::vector<ChunkEntry> mEntries;
    std::map<std::tuple<ChunkTag, uint32_t, uint32_t>, size_t> mIndex; // (tag, owner, run)
};

// Return the location of chunks for error messages: file, tag and owner, and the run of a single entry.
// `ownerKind` is "part" or "set".
std::string whereOf(const ChunkFile& file, ChunkTag tag, uint32_t owner, const char* ownerKind);
std::string whereOf(const ChunkFile& file, const ChunkEntry& entry, const char* ownerKind);

// Returns the chunks of an array. Throws Error, before anything is allocated for them, unless they have
// contentBytes in total besides headers of chunkBytes each.
std::vector<ChunkEntry> findSized(const ChunkFile& file, ChunkTag tag, uint32_t owner, uint64_t chunkBytes,
                                  uint64_t contentBytes, const char* ownerKind);

} // namespace relume

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

// Four letters. A reader that does not know a tag refuses the file if the first letter is a capital, and
// skips the chunk otherwise.
using ChunkTag = std::array<char, 4>;
constexpr ChunkTag chunkTag(const char (&text)[5]) { return {text[0], text[1], text[2], text[3]}; }
constexpr bool isRequired(ChunkTag tag) { return tag[0] >= 'A' && tag[0] <= 'Z'; }
std::string tagText(ChunkTag tag); // for messages: anything but letters and digits becomes '?'

// Owner of chunks that belong to the file as a whole.
constexpr uint32_t kWholeFile = 0xffffffff;

// Limits that bound what a reader must hold, and what a small file can make it allocate.
constexpr size_t kLargestChunk = size_t(8) << 20; // bytes before compression
constexpr uint64_t kLargestRatio = 1024;          // raw size ≤ kLargestRatio · stored size + kRatioSlack
constexpr uint64_t kRatioSlack = 65536;

// A line of the table. A long array is cut into chunks of the same tag and owner: run 0, 1, 2, ….
struct ChunkEntry {
    ChunkTag tag{};
    uint32_t owner = kWholeFile; // a part, or a set of materials counted over all parts
    uint32_t run = 0;
    uint64_t offset = 0; // from the start of the file
    uint64_t storedSize = 0;
    uint64_t rawSize = 0; // equal to storedSize: stored plainly; else one zstd frame
    uint64_t checksum = 0;
};

// A chunk as it lies in a file, wherever that will be: its entry's offset is yet to be set.
struct StoredChunk {
    ChunkEntry entry;
    std::vector<std::byte> bytes;
};

// Compresses 1 to kLargestChunk bytes.
StoredChunk storeChunk(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw);

// Collects chunks in file order, compressing each as it comes, and gives the bytes of the file.
class ChunkWriter {
  public:
    // Gives the stored bytes of a chunk that is kept elsewhere.
    using Load = std::function<std::vector<std::byte>()>;
    // Takes the next bytes of the file.
    using Output = std::function<void(std::span<const std::byte>)>;

    void add(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw);
    // `load` is called once, by finish(), when the chunk's turn comes: no two are held at a time.
    void addStored(const ChunkEntry& entry, Load load);

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

// The bytes of a file, wherever they are.
struct ByteSource {
    uint64_t size = 0;
    // Gives `count` bytes from `offset` on, which lie within `size`; `room` is for those that are in no
    // memory yet.
    std::function<std::span<const std::byte>(uint64_t offset, size_t count, std::vector<std::byte>& room)>
        read;
};
ByteSource sourceOf(std::span<const std::byte> bytes); // which must outlive it

// What a stored chunk stands for. Throws Error; `name` stands for the file there.
std::vector<std::byte> unpackChunk(const ChunkEntry& entry, std::span<const std::byte> stored,
                                   const std::string& name);

// Whether these bytes begin as a .relume file of any version does.
bool hasAssetMagic(std::span<const std::byte> bytes);

// A checked view of a file.
class ChunkFile {
  public:
    // Verifies everything but the chunks' contents: magic, version, every checksum, sizes, limits, order of
    // runs. Holds the table and one chunk at a time. `name` stands for the file in errors. Throws Error.
    ChunkFile(ByteSource source, std::string name, uint32_t version = kAssetFormatVersion);
    ChunkFile(std::span<const std::byte> bytes, std::string name) // which must outlive it
        : ChunkFile(sourceOf(bytes), std::move(name)) {}

    // In file order.
    const std::vector<ChunkEntry>& entries() const { return mEntries; }

    // The runs of an array, in order; none for an empty one.
    std::vector<ChunkEntry> find(ChunkTag tag, uint32_t owner) const;

    // A single run, whatever others there are; null where it is missing.
    const ChunkEntry* findRun(ChunkTag tag, uint32_t owner, uint32_t run) const;

    // A chunk's bytes, decompressed. Throws Error.
    std::vector<std::byte> load(const ChunkEntry& entry) const;

    // A chunk's bytes as they lie in the file, once more held against their checksum: a file on disk may have
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

// Name the chunks of a tag and owner, a "part" or a "set", or one of them, in errors.
std::string whereOf(const ChunkFile& file, ChunkTag tag, uint32_t owner, const char* ownerKind);
std::string whereOf(const ChunkFile& file, const ChunkEntry& entry, const char* ownerKind);

// Chunks of an array, whose headers of `chunkBytes` and content are checked to have these bytes before
// anything is allocated for them. Throws Error.
std::vector<ChunkEntry> findSized(const ChunkFile& file, ChunkTag tag, uint32_t owner, uint64_t chunkBytes,
                                  uint64_t contentBytes, const char* ownerKind);

} // namespace relume

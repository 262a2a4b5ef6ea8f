#include "engine/chunk/chunk_file.h"

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/chunk/byte_stream.h"

#include <algorithm>
#include <cctype>
#include <fmt/core.h>
#include <memory>
#include <zstd.h>

namespace relume {

namespace {

constexpr std::array<char, 8> kMagic = {'R', 'E', 'L', 'U', 'M', 'E', '\r', '\n'};
constexpr size_t kHeaderBytes = 32, kEntryBytes = 48;
constexpr size_t kHeaderChecksumOffset = 24;

// Level 1: chunks are nearly incompressible beyond that; higher levels save 1 % and halve the speed.
constexpr int kCompressionLevel = 1;

bool withinRatio(uint64_t raw, uint64_t stored) {
    return raw <= kRatioSlack || (raw - kRatioSlack + kLargestRatio - 1) / kLargestRatio <= stored;
}

void putEntry(ByteWriter& out, const ChunkEntry& entry) {
    out.put(std::as_bytes(std::span(entry.tag)));
    out.put(entry.owner);
    out.put(entry.run);
    out.put(uint32_t(0));
    out.put(entry.offset);
    out.put(entry.storedSize);
    out.put(entry.rawSize);
    out.put(entry.checksum);
}

ChunkEntry getEntry(ByteReader& in, const std::string& name) {
    ChunkEntry entry;
    for (char& letter : entry.tag) letter = char(in.get<uint8_t>());
    entry.owner = in.get<uint32_t>();
    entry.run = in.get<uint32_t>();
    const auto reserved = in.get<uint32_t>();
    if (reserved != 0)
        throw Error(fmt::format("{}: chunk {}: expected 0 in a reserved field, found {}", name,
                                tagText(entry.tag), reserved));
    entry.offset = in.get<uint64_t>();
    entry.storedSize = in.get<uint64_t>();
    entry.rawSize = in.get<uint64_t>();
    entry.checksum = in.get<uint64_t>();
    return entry;
}

// Returns the checksum of the header, up to its own checksum field, and of the table.
uint64_t headerChecksum(std::span<const std::byte> header, std::span<const std::byte> table) {
    std::vector<std::byte> both(header.begin(), header.begin() + kHeaderChecksumOffset);
    both.insert(both.end(), table.begin(), table.end());
    return hash64(both);
}

// Describes a chunk for messages.
std::string chunkText(ChunkTag tag, uint32_t owner) {
    return owner == kWholeFile ? fmt::format("chunk {} of the file", tagText(tag))
                               : fmt::format("chunk {} of part or set {}", tagText(tag), owner);
}

} // namespace

std::string tagText(ChunkTag tag) {
    std::string text(tag.begin(), tag.end());
    for (char& letter : text)
        if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '?';
    return text;
}

StoredChunk storeChunk(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw) {
    RELUME_CHECK(!raw.empty() && raw.size() <= kLargestChunk);
    std::vector<std::byte> bytes(ZSTD_compressBound(raw.size()));
    const size_t stored =
        ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), kCompressionLevel);
    if (ZSTD_isError(stored)) throw Error(fmt::format("compression failed: {}", ZSTD_getErrorName(stored)));
    if (stored >= raw.size() || !withinRatio(raw.size(), stored))
        bytes.assign(raw.begin(), raw.end());
    else
        bytes.resize(stored);
    const ChunkEntry entry{tag, owner, run, 0, bytes.size(), raw.size(), hash64(bytes)};
    return {entry, std::move(bytes)};
}

void ChunkWriter::add(ChunkTag tag, uint32_t owner, uint32_t run, std::span<const std::byte> raw) {
    StoredChunk chunk = storeChunk(tag, owner, run, raw);
    chunk.entry.offset = mData.size();
    mData.insert(mData.end(), chunk.bytes.begin(), chunk.bytes.end());
    mPieces.push_back({chunk.entry, nullptr});
}

void ChunkWriter::addStored(const ChunkEntry& entry, Load load) {
    mPieces.push_back({entry, std::move(load)});
}

void ChunkWriter::finish(const Output& output) {
    uint64_t offset = kHeaderBytes + mPieces.size() * kEntryBytes;
    ByteWriter table;
    for (const Piece& piece : mPieces) {
        ChunkEntry entry = piece.entry;
        entry.offset = offset;
        offset += entry.storedSize;
        putEntry(table, entry);
    }
    ByteWriter header;
    header.put(std::as_bytes(std::span(kMagic)));
    header.put(kAssetFormatVersion);
    header.put(uint32_t(mPieces.size()));
    header.put(offset);
    header.put(headerChecksum(header.bytes(), table.bytes()));
    output(header.bytes());
    output(table.bytes());
    for (const Piece& piece : mPieces) {
        if (!piece.load) {
            output(std::span(mData).subspan(piece.entry.offset, piece.entry.storedSize));
            continue;
        }
        const std::vector<std::byte> bytes = piece.load();
        RELUME_CHECK_EQ(bytes.size(), piece.entry.storedSize);
        output(bytes);
    }
}

std::vector<std::byte> ChunkWriter::finish() {
    std::vector<std::byte> file;
    finish([&](std::span<const std::byte> bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); });
    return file;
}

ByteSource sourceOf(std::span<const std::byte> bytes) {
    return {bytes.size(), [bytes](uint64_t offset, size_t count, std::vector<std::byte>&) {
                return bytes.subspan(offset, count);
            }};
}

std::vector<std::byte> unpackChunk(const ChunkEntry& entry, std::span<const std::byte> stored,
                                   const std::string& name) {
    if (entry.storedSize == entry.rawSize) return {stored.begin(), stored.end()};
    const unsigned long long content = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (content != entry.rawSize)
        throw Error(fmt::format("{}: chunk {}: is not a zstd frame of {} bytes", name, tagText(entry.tag),
                                entry.rawSize));
    std::vector<std::byte> raw(entry.rawSize);
    const size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
    if (size != raw.size())
        throw Error(fmt::format("{}: chunk {}: cannot be decompressed: {}", name, tagText(entry.tag),
                                ZSTD_isError(size) ? ZSTD_getErrorName(size) : "too short"));
    return raw;
}

ChunkFile::ChunkFile(ByteSource source, std::string name, uint32_t version)
    : mSource(std::move(source)), mName(std::move(name)) {
    readTable(version);
    uint64_t offset = kHeaderBytes + mEntries.size() * kEntryBytes;
    std::vector<std::byte> room;
    for (size_t i = 0; i < mEntries.size(); i++) {
        const ChunkEntry& entry = mEntries[i];
        checkEntry(entry, offset, room);
        offset += entry.storedSize;
        if (!mIndex.try_emplace({entry.tag, entry.owner, entry.run}, i).second)
            throw Error(fmt::format("{}: {}, run {}, appears twice", mName, chunkText(entry.tag, entry.owner),
                                    entry.run));
    }
    if (offset != mSource.size)
        throw Error(
            fmt::format("{}: {} bytes are left over behind the last chunk", mName, mSource.size - offset));
}

bool hasAssetMagic(std::span<const std::byte> bytes) {
    return bytes.size() >= kMagic.size() &&
           std::ranges::equal(bytes.first(kMagic.size()), std::as_bytes(std::span(kMagic)));
}

void ChunkFile::readTable(uint32_t expectedVersion) {
    std::vector<std::byte> headerRoom, tableRoom;
    const auto header = mSource.read(0, size_t(std::min<uint64_t>(mSource.size, kHeaderBytes)), headerRoom);
    if (header.size() < kHeaderBytes || !hasAssetMagic(header))
        throw Error(fmt::format(
            "{}: not a .relume file ({} bytes, and no header of one); make one with `relume bake`", mName,
            mSource.size));
    ByteReader in(header, mName);
    in.take(kMagic.size());
    const auto version = in.get<uint32_t>();
    if (version != expectedVersion)
        throw Error(fmt::format("{}: has format version {}, this program reads version {}; {}", mName,
                                version, expectedVersion,
                                version == expectedVersion - 1 ? "`relume convert` updates it"
                                : version > expectedVersion    ? "update the program"
                                                               : "bake again"));
    const auto count = in.get<uint32_t>();
    const auto fileBytes = in.get<uint64_t>();
    const auto checksum = in.get<uint64_t>();
    if (fileBytes != mSource.size)
        throw Error(fmt::format(
            "{}: expected {} bytes, found {}; the file is cut short or damaged: copy or bake it again", mName,
            fileBytes, mSource.size));
    if (count > (mSource.size - kHeaderBytes) / kEntryBytes)
        throw Error(
            fmt::format("{}: names {} chunks, more than its {} bytes can hold", mName, count, mSource.size));
    const auto table = mSource.read(kHeaderBytes, count * kEntryBytes, tableRoom);
    if (headerChecksum(header, table) != checksum)
        throw Error(fmt::format(
            "{}: header or chunk table fails its checksum; the file is damaged: copy or bake it again",
            mName));
    ByteReader rows(table, mName);
    mEntries.reserve(count);
    for (uint32_t i = 0; i < count; i++) mEntries.push_back(getEntry(rows, mName));
}

// Chunks must lie end to end, so that none is counted twice and nothing is hidden between them.
void ChunkFile::checkEntry(const ChunkEntry& entry, uint64_t expectedOffset,
                           std::vector<std::byte>& room) const {
    const std::string tag = tagText(entry.tag);
    if (entry.offset != expectedOffset)
        throw Error(fmt::format("{}: chunk {}: expected at byte {}, found at {}", mName, tag, expectedOffset,
                                entry.offset));
    if (entry.storedSize == 0 || entry.storedSize > mSource.size - entry.offset)
        throw Error(fmt::format("{}: chunk {}: {} bytes at {} do not fit a file of {}", mName, tag,
                                entry.storedSize, entry.offset, mSource.size));
    if (entry.rawSize < entry.storedSize || entry.rawSize > kLargestChunk ||
        !withinRatio(entry.rawSize, entry.storedSize))
        throw Error(fmt::format("{}: chunk {}: {} bytes cannot stand for {}", mName, tag, entry.storedSize,
                                entry.rawSize));
    expectChecksum(entry, mSource.read(entry.offset, entry.storedSize, room));
}

void ChunkFile::expectChecksum(const ChunkEntry& entry, std::span<const std::byte> stored) const {
    if (hash64(stored) != entry.checksum)
        throw Error(fmt::format("{}: {} fails its checksum; the file is damaged: copy or bake it again",
                                mName, chunkText(entry.tag, entry.owner)));
}

std::vector<ChunkEntry> ChunkFile::find(ChunkTag tag, uint32_t owner) const {
    std::vector<ChunkEntry> runs;
    for (auto at = mIndex.lower_bound({tag, owner, 0}); at != mIndex.end(); ++at) {
        const ChunkEntry& entry = mEntries[at->second];
        if (entry.tag != tag || entry.owner != owner) break;
        if (entry.run != runs.size())
            throw Error(fmt::format("{}: {}: run {} is missing", mName, chunkText(tag, owner), runs.size()));
        runs.push_back(entry);
    }
    return runs;
}

const ChunkEntry* ChunkFile::findRun(ChunkTag tag, uint32_t owner, uint32_t run) const {
    const auto at = mIndex.find({tag, owner, run});
    return at == mIndex.end() ? nullptr : &mEntries[at->second];
}

std::vector<std::byte> ChunkFile::load(const ChunkEntry& entry) const {
    std::vector<std::byte> room;
    return unpackChunk(entry, mSource.read(entry.offset, entry.storedSize, room), mName);
}

std::vector<std::byte> ChunkFile::loadStored(const ChunkEntry& entry) const {
    std::vector<std::byte> room;
    const auto stored = mSource.read(entry.offset, entry.storedSize, room);
    expectChecksum(entry, stored);
    if (room.empty()) room.assign(stored.begin(), stored.end());
    return room;
}

std::string whereOf(const ChunkFile& file, ChunkTag tag, uint32_t owner, const char* ownerKind) {
    const std::string of = owner == kWholeFile ? "" : fmt::format(" of {} {}", ownerKind, owner);
    return fmt::format("{}: chunk {}{}", file.name(), tagText(tag), of);
}

std::string whereOf(const ChunkFile& file, const ChunkEntry& entry, const char* ownerKind) {
    return fmt::format("{}, run {}", whereOf(file, entry.tag, entry.owner, ownerKind), entry.run);
}

std::vector<ChunkEntry> findSized(const ChunkFile& file, ChunkTag tag, uint32_t owner, uint64_t chunkBytes,
                                  uint64_t contentBytes, const char* ownerKind) {
    const std::vector<ChunkEntry> runs = file.find(tag, owner);
    uint64_t found = 0;
    for (const ChunkEntry& run : runs) found += run.rawSize;
    const uint64_t expected = contentBytes + chunkBytes * runs.size();
    if (found != expected)
        throw Error(fmt::format("{}: expected {} bytes, found {}", whereOf(file, tag, owner, ownerKind),
                                expected, found));
    return runs;
}

} // namespace relume

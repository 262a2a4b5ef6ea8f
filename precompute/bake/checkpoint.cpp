#include "precompute/bake/checkpoint.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/log.h"
#include "engine/chunk/byte_stream.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace relume {

namespace {

constexpr std::array<char, 8> kMagic = {'R', 'E', 'L', 'U', 'M', 'E', 'C', 'P'};
constexpr uint32_t kVersion = 2;
constexpr size_t kHeaderBytes = kMagic.size() + 4 + kIdentityBytes + 8;
constexpr uint32_t kScale = 0xffffffff; // marks the scale, in place of a block's number
constexpr size_t kRecordHeaderBytes = 4 + 4 + 8 + 8, kChunkBytes = 4 + 4 + 4 + 8 + 8 + 8;

// Time between flushes to disk: what a crash of the machine may lose. A crash of the program loses nothing
// appended.
constexpr std::chrono::seconds kSyncInterval{5};

std::vector<std::byte> headerOf(const BakePlan& plan) {
    RELUME_CHECK_EQ(plan.identity.size(), kIdentityBytes);
    ByteWriter out;
    out.put(std::as_bytes(std::span(kMagic)));
    out.put(kVersion);
    out.put(std::as_bytes(std::span(plan.identity)));
    out.put(hash64(out.bytes()));
    return out.take();
}

// Returns the checksum of a record: of its header before the checksum, and of its body.
uint64_t recordChecksum(std::span<const std::byte> header, std::span<const std::byte> body) {
    std::vector<std::byte> both(header.begin(), header.end());
    both.insert(both.end(), body.begin(), body.end());
    return hash64(both);
}

void putLosses(ByteWriter& out, const TransportLosses& losses) {
    for (double sum : {losses.total, losses.dropped, losses.quantized, losses.layout})
        out.put(std::bit_cast<uint64_t>(sum));
}

TransportLosses getLosses(ByteReader& in) {
    const auto next = [&] { return std::bit_cast<double>(in.get<uint64_t>()); };
    const double total = next(), dropped = next(), quantized = next();
    return {total, dropped, quantized, next()};
}

void putChunk(ByteWriter& out, const ChunkEntry& entry) {
    out.put(std::as_bytes(std::span(entry.tag)));
    out.put(entry.owner);
    out.put(entry.run);
    out.put(entry.storedSize);
    out.put(entry.rawSize);
    out.put(entry.checksum);
}

uint64_t scaleBytes(const BakePlan& plan) { return sizeof(double) + plan.setCount() * sizeof(float); }

ChunkEntry getChunk(ByteReader& in) {
    ChunkEntry entry;
    for (char& letter : entry.tag) letter = char(in.get<uint8_t>());
    entry.owner = in.get<uint32_t>();
    entry.run = in.get<uint32_t>();
    entry.storedSize = in.get<uint64_t>();
    entry.rawSize = in.get<uint64_t>();
    entry.checksum = in.get<uint64_t>();
    return entry;
}

} // namespace

Checkpoint::Checkpoint(std::filesystem::path path) : mPath(std::move(path)) {
    lock();
    std::array<std::byte, kMagic.size()> magic{};
    const size_t known = std::min<uint64_t>(mBytes, magic.size());
    if (!read(0, std::span(magic).first(known)) ||
        !std::ranges::equal(std::span(magic).first(known), std::as_bytes(std::span(kMagic)).first(known))) {
        close(mFile);
        throw Error(
            fmt::format("{}: expected a checkpoint of an earlier bake, found another file; move it away",
                        mPath.string()));
    }
}

// Checks after locking that the file still has its name: a finished bake may just have removed it.
void Checkpoint::lock() {
    for (;;) {
        mFile = open(mPath.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, 0666);
        struct stat opened {
        }, named{};
        if (mFile < 0 || fstat(mFile, &opened) != 0 || !S_ISREG(opened.st_mode)) {
            const std::string why = mFile < 0 ? std::strerror(errno) : "it is no regular file";
            if (mFile >= 0) close(mFile);
            throw Error(fmt::format("{}: the bake's checkpoint cannot be written: {}", mPath.string(), why));
        }
        if (flock(mFile, LOCK_EX | LOCK_NB) != 0) {
            const bool isTaken = errno == EWOULDBLOCK;
            const std::string why = std::strerror(errno);
            close(mFile);
            if (isTaken)
                throw Error(fmt::format(
                    "{}: another bake is writing this output; wait for it, stop it, or name another "
                    "output",
                    mPath.string()));
            throw Error(fmt::format("{}: cannot be locked: {}", mPath.string(), why));
        }
        if (stat(mPath.c_str(), &named) == 0 && named.st_ino == opened.st_ino &&
            named.st_dev == opened.st_dev) {
            mBytes = uint64_t(opened.st_size);
            return;
        }
        close(mFile);
    }
}

Checkpoint::~Checkpoint() {
    if (mFile < 0) return;
    if (mBytes == 0) unlink(mPath.c_str());
    close(mFile);
}

bool Checkpoint::read(uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = pread(mFile, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        offset += uint64_t(count);
        bytes = bytes.subspan(size_t(count));
    }
    return true;
}

bool Checkpoint::matches(const BakePlan& plan) const {
    const std::vector<std::byte> expected = headerOf(plan);
    std::vector<std::byte> found(expected.size());
    return read(0, found) && found == expected;
}

void Checkpoint::resume(const BakePlan& plan) {
    mBlocks.assign(plan.blocks.size(), std::nullopt);
    mScale.reset();
    const uint64_t fileBytes = mBytes;
    mBytes = 0;
    if (matches(plan)) {
        mBytes = kHeaderBytes;
        while (mBytes < fileBytes && readRecord(plan)) {
        }
    } else if (fileBytes > kHeaderBytes) {
        log(LogLevel::Warning,
            fmt::format("{}: is of a bake of other inputs, options, device or program; starting over",
                        mPath.string()));
    }
    if (mBytes < fileBytes && ftruncate(mFile, off_t(mBytes)) != 0)
        throw Error(
            fmt::format("{}: cannot be cut to its valid part: {}", mPath.string(), std::strerror(errno)));
    if (mBytes == 0) write(headerOf(plan));
    mSynced = std::chrono::steady_clock::now();
}

// Reads the record at mBytes and advances past it, if it is intact and is either a block not yet read or the
// scale, which precedes all blocks that are not in rows.
bool Checkpoint::readRecord(const BakePlan& plan) {
    std::array<std::byte, kRecordHeaderBytes> header{};
    if (!read(mBytes, header)) return false;
    ByteReader in(header, "");
    const auto block = in.get<uint32_t>(), chunkCount = in.get<uint32_t>();
    const auto bodyBytes = in.get<uint64_t>(), checksum = in.get<uint64_t>();
    if (block == kScale ? !plan.needsScale() : plan.needsScale() && !mScale) return false;
    uint64_t least = scaleBytes(plan), most = least;
    size_t chunks = 0;
    if (block != kScale) {
        if (block >= plan.blocks.size() || mBlocks[block]) return false;
        chunks = chunksOf(plan, block);
        least = most = kBytesPerLoss + chunks * kChunkBytes;
        for (size_t chunk = 0; chunk < chunks; chunk++) most += mostRawBytes(plan, block, chunk);
    }
    if (chunkCount != chunks || bodyBytes < least || bodyBytes > most) return false;
    std::vector<std::byte> body(bodyBytes);
    if (!read(mBytes + header.size(), body) ||
        recordChecksum(std::span(header).first(kRecordHeaderBytes - 8), body) != checksum)
        return false;
    if (block == kScale) {
        if (!readScale(plan, body)) return false;
        mBytes += header.size() + bodyBytes;
        return true;
    }

    ByteReader rest(body, "");
    Kept kept{getLosses(rest), {}};
    uint64_t offset = mBytes + header.size() + kBytesPerLoss + chunkCount * kChunkBytes;
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        ChunkEntry entry = getChunk(rest);
        if (!isPlausible(plan, block, chunk, entry)) return false;
        entry.offset = offset;
        offset += entry.storedSize;
        kept.chunks.push_back(entry);
    }
    if (offset != mBytes + header.size() + bodyBytes) return false;
    mBlocks[block] = std::move(kept);
    mBytes = offset;
    return true;
}

bool Checkpoint::readScale(const BakePlan& plan, std::span<const std::byte> body) {
    ByteReader in(body, "");
    LayoutScale scale;
    scale.lambda = std::bit_cast<double>(in.get<uint64_t>());
    for (size_t set = 0; set < plan.setCount(); set++)
        scale.norms.push_back(std::bit_cast<float>(in.get<uint32_t>()));
    const auto isPositive = [](float norm) { return std::isfinite(norm) && norm > 0; };
    if (mScale || !std::isfinite(scale.lambda) || scale.lambda < 0 ||
        !std::ranges::all_of(scale.norms, isPositive))
        return false;
    mScale = std::move(scale);
    return true;
}

void Checkpoint::append(const LayoutScale& scale) {
    RELUME_CHECK(!mScale);
    ByteWriter body;
    body.put(std::bit_cast<uint64_t>(scale.lambda));
    for (const float norm : scale.norms) body.put(std::bit_cast<uint32_t>(norm));
    writeRecord(kScale, 0, body.bytes());
    mScale = scale;
}

void Checkpoint::append(uint32_t block, const StoredBlock& stored) {
    RELUME_CHECK(!has(block));
    ByteWriter body;
    putLosses(body, stored.losses);
    for (const StoredChunk& chunk : stored.chunks) putChunk(body, chunk.entry);
    Kept kept{stored.losses, {}};
    for (const StoredChunk& chunk : stored.chunks) {
        kept.chunks.push_back(chunk.entry);
        kept.chunks.back().offset = mBytes + kRecordHeaderBytes + body.bytes().size();
        body.put(chunk.bytes);
    }
    writeRecord(block, uint32_t(stored.chunks.size()), body.bytes());
    mBlocks[block] = std::move(kept);
}

void Checkpoint::writeRecord(uint32_t block, uint32_t count, std::span<const std::byte> body) {
    ByteWriter record;
    record.put(block);
    record.put(count);
    record.put(uint64_t(body.size()));
    record.put(recordChecksum(record.bytes(), body));
    record.put(body);
    write(record.bytes());
}

void Checkpoint::write(std::span<const std::byte> bytes) {
    uint64_t offset = mBytes;
    const uint64_t end = offset + bytes.size();
    const auto fail = [&] {
        const std::string why = std::strerror(errno);
        (void)!ftruncate(mFile, off_t(mBytes));
        throw Error(fmt::format("{}: cannot be written: {}; the same command goes on from here once it can",
                                mPath.string(), why));
    };
    while (!bytes.empty()) {
        const ssize_t count = pwrite(mFile, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail();
        offset += uint64_t(count);
        bytes = bytes.subspan(size_t(count));
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - mSynced >= kSyncInterval) {
        if (fdatasync(mFile) != 0) fail();
        mSynced = now;
    }
    mBytes = end;
}

std::vector<std::byte> Checkpoint::load(uint32_t, const ChunkEntry& entry) const {
    std::vector<std::byte> bytes(entry.storedSize);
    if (!read(entry.offset, bytes))
        throw Error(fmt::format("{}: cannot be read: {}", mPath.string(), std::strerror(errno)));
    if (hash64(bytes) != entry.checksum)
        throw Error(
            fmt::format("{}: a block fails its checksum; remove the file and bake again", mPath.string()));
    return bytes;
}

void Checkpoint::remove() {
    unlink(mPath.c_str());
    close(mFile);
    mFile = -1;
}

} // namespace relume

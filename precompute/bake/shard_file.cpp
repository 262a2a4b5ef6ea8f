#include "precompute/bake/shard_file.h"

#include "engine/base/check.h"
#include "engine/chunk/byte_stream.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_file.h"
#include "engine/transport/layout_chunks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr size_t kShardBytes = 4 + 4 + kIdentityBytes;
constexpr size_t kLossesPerChunk = size_t(1) << 18;
static_assert(kLossesPerChunk * kBytesPerLoss <= kLargestChunk);

void addShard(ChunkWriter& file, const BakePlan& plan, const Shard& shard) {
    RELUME_CHECK_EQ(plan.identity.size(), kIdentityBytes);
    ByteWriter out;
    out.put(shard.index);
    out.put(shard.count);
    out.put(std::as_bytes(std::span(plan.identity)));
    file.add(kShard, kWholeFile, 0, out.bytes());
}

void addLosses(ChunkWriter& file, std::span<const TransportLosses> losses) {
    for (uint32_t run = 0; !losses.empty(); run++) {
        const auto own = losses.first(std::min(losses.size(), kLossesPerChunk));
        ByteWriter out;
        for (const TransportLosses& loss : own)
            for (double sum : {loss.total, loss.dropped, loss.quantized, loss.layout})
                out.put(std::bit_cast<uint64_t>(sum));
        file.add(kBlockLosses, kWholeFile, run, out.bytes());
        losses = losses.subspan(own.size());
    }
}

ByteSource sourceOf(std::shared_ptr<FileReader> file, ShardFile::Watch watch) {
    const uint64_t size = file->size();
    return {size, [file = std::move(file), watch = std::move(watch)](uint64_t offset, size_t count,
                                                                     std::vector<std::byte>& room) {
                room.resize(count);
                file->read(offset, room);
                watch(count);
                return std::span<const std::byte>(room);
            }};
}

} // namespace

void writeShard(const BakePlan& plan, const Shard& shard, const StoredBlocks& blocks,
                const ChunkWriter::Output& output) {
    std::vector<uint32_t> numbers;
    std::vector<TransportLosses> losses;
    for (uint32_t block = shard.index; block < plan.blocks.size(); block += shard.count) {
        numbers.push_back(block);
        losses.push_back(blocks.losses(block));
    }
    ChunkWriter chunks;
    addShard(chunks, plan, shard);
    addLosses(chunks, losses);
    // META as in the identity: without entry counts and errors, which no shard knows.
    addBlocks(chunks, plan, blocks, numbers, std::vector<uint64_t>(plan.setCount(), 0));
    chunks.finish(output);
}

ShardFile::ShardFile(const std::filesystem::path& path, const Watch& watch)
    : ShardFile(sourceOf(std::make_shared<FileReader>(path), watch), path.string()) {}

ShardFile::ShardFile(ByteSource source, std::string name)
    : mChunks(std::move(source), std::move(name)), mMeta(readMeta(mChunks, AssetFileKind::Shard)) {
    const std::vector<std::byte> meta = mChunks.load(*mChunks.findRun(kMeta, kWholeFile, 0));
    mMetaText.assign(reinterpret_cast<const char*>(meta.data()), meta.size());
    const std::vector<ChunkEntry> runs = mChunks.find(kShard, kWholeFile);
    if (runs.size() != 1 || runs[0].rawSize != kShardBytes)
        throw Error(fmt::format("{}: expected one chunk SHRD of {} bytes", this->name(), kShardBytes));
    const std::vector<std::byte> raw = mChunks.load(runs[0]);
    ByteReader in(raw, this->name());
    mShard.index = in.get<uint32_t>();
    mShard.count = in.get<uint32_t>();
    if (mShard.count < 1 || mShard.count > kMostShards || mShard.index >= mShard.count)
        throw Error(fmt::format("{}: says to be shard {} of {}; the file is damaged: bake it again",
                                this->name(), mShard.index, mShard.count));
    for (const std::byte letter : in.take(kIdentityBytes)) mIdentity.push_back(char(letter));
}

BakePlan ShardFile::plan() const {
    AssetMeta meta = mMeta;
    readArrays(mChunks, meta);
    checkSkeleton(meta.asset, name());
    for (const AssetPart& part : meta.asset.parts) // no chunk of transport contains these
        for (const MaterialSet& set : part.sets)
            std::visit(
                [&](const auto& layout) {
                    checkLayout(layout, fmt::format("{}: transport of part \"{}\"", name(), part.name));
                },
                set.transport);
    BakePlan plan = planOf(std::move(meta.asset), meta.visibilityKey);
    if (plan.identity != mIdentity)
        throw Error(fmt::format(
            "{}: holds something else than its identity says; the file was edited, or made by another "
            "program: bake it again",
            name()));
    return plan;
}

std::vector<TransportLosses> ShardFile::losses(uint32_t blocks) const {
    const std::vector<ChunkEntry> runs = mChunks.find(kBlockLosses, kWholeFile);
    uint64_t bytes = 0;
    for (const ChunkEntry& run : runs) bytes += run.rawSize;
    if (bytes != blocks * uint64_t(kBytesPerLoss))
        throw Error(fmt::format("{}: chunk LOSS: expected {} bytes for {} blocks, found {}", name(),
                                blocks * uint64_t(kBytesPerLoss), blocks, bytes));
    std::vector<TransportLosses> losses;
    for (const ChunkEntry& run : runs) {
        const std::vector<std::byte> raw = mChunks.load(run);
        ByteReader in(raw, name());
        while (in.left() > 0) {
            const auto next = [&] {
                const double sum = std::bit_cast<double>(in.get<uint64_t>());
                if (!std::isfinite(sum) || sum < 0)
                    throw Error(fmt::format("{}: chunk LOSS: expected finite sums of squares, found {}",
                                            name(), sum));
                return sum;
            };
            TransportLosses& loss = losses.emplace_back();
            loss.total = next();
            loss.dropped = next();
            loss.quantized = next();
            loss.layout = next();
        }
    }
    return losses;
}

} // namespace relume

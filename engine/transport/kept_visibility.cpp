#include "engine/transport/kept_visibility.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/visibility_chunk.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

static ByteSource sourceOf(const std::filesystem::path& path) {
    const auto file = std::make_shared<FileReader>(path);
    return {file->size(), [file](uint64_t offset, size_t count, std::vector<std::byte>& room) {
                room.resize(count);
                file->read(offset, room);
                return std::span<const std::byte>(room);
            }};
}

KeptVisibility::KeptVisibility(const std::filesystem::path& path)
    : KeptVisibility(sourceOf(path), path.string()) {}

KeptVisibility::KeptVisibility(ByteSource source, const std::string& name)
    : mFile(std::move(source), name), mMeta(readMeta(mFile, AssetFileKind::Bake)),
      mRun(visibilityRunVertices(mMeta.asset)) {
    for (uint32_t part = 0; part < mMeta.sizes.parts.size(); part++)
        mRuns.push_back(mFile.find(kVisibility, part));
}

Asset KeptVisibility::skeleton() const {
    AssetMeta meta = mMeta;
    readArrays(mFile, meta);
    checkSkeleton(meta.asset, mFile.name());
    return std::move(meta.asset);
}

uint32_t KeptVisibility::runVertices(uint32_t part, uint32_t run) const {
    return uint32_t(std::min<uint64_t>(mRun, mMeta.sizes.parts[part].vertices - uint64_t(run) * mRun));
}

void KeptVisibility::verify(const Asset& asset) const {
    const auto isAsLong = [](const AssetPart& part, const AssetPartSizes& sizes) {
        return part.mesh.vertexCount() == sizes.vertices;
    };
    if (size() != uint32_t(asset.visibilitySize) ||
        !std::ranges::equal(asset.parts, mMeta.sizes.parts, isAsLong))
        throw Error(
            fmt::format("{}: its visibility is not that of its parts; the file is damaged", mFile.name()));
    if (size() % kSmallestKeptVisibility != 0)
        throw Error(fmt::format("{}: visibility of {} texels a side cannot be kept", mFile.name(), size()));
    for (uint32_t part = 0; part < mRuns.size(); part++) {
        const uint64_t expected = (mMeta.sizes.parts[part].vertices + mRun - 1) / mRun;
        if (mRuns[part].size() != expected)
            throw Error(
                fmt::format("{}: visibility of part {}: expected {} chunks, found {}; the file is damaged",
                            mFile.name(), part, expected, mRuns[part].size()));
        for (const ChunkEntry& entry : mRuns[part]) {
            const uint32_t vertices = runVertices(part, entry.run);
            if (entry.rawSize < smallestVisibilityChunk(vertices, size()) ||
                entry.rawSize > largestVisibilityChunk(vertices, size()))
                throw Error(fmt::format(
                    "{}: visibility of part {}, run {}: {} bytes cannot be that of {} vertices; the "
                    "file is damaged",
                    mFile.name(), part, entry.run, entry.rawSize, vertices));
        }
    }
}

const std::vector<uint32_t>& KeptVisibility::run(uint32_t part, uint32_t run) {
    if (!mLast || mLast->part != part || mLast->run != run) {
        mLast.reset();
        const std::string where = fmt::format("{}: visibility of part {}, run {}", mFile.name(), part, run);
        if (run >= mRuns[part].size()) throw Error(fmt::format("{}: is missing; the file is damaged", where));
        mLast = {part, run,
                 decodeVisibility(mFile.load(mRuns[part][run]), runVertices(part, run), size(), where)};
    }
    return mLast->bits;
}

std::vector<uint32_t> KeptVisibility::bits(uint32_t part, uint32_t first, uint32_t end) {
    RELUME_CHECK(first <= end && end <= mMeta.sizes.parts[part].vertices);
    const size_t words = 6 * size_t(size()) * size() / 32;
    std::vector<uint32_t> found;
    found.reserve((end - first) * words);
    while (first < end) {
        const uint32_t number = first / mRun, start = first - number * mRun;
        const std::vector<uint32_t>& bits = run(part, number);
        const uint32_t count = std::min(end - first, runVertices(part, number) - start);
        const auto from = bits.begin() + ptrdiff_t(start * words);
        found.insert(found.end(), from, from + ptrdiff_t(count * words));
        first += count;
    }
    return found;
}

uint64_t KeptVisibility::storedBytes() const {
    uint64_t bytes = 0;
    for (const auto& runs : mRuns)
        for (const ChunkEntry& entry : runs) bytes += entry.storedSize;
    return bytes;
}

} // namespace relume

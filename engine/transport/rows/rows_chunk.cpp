#include "engine/transport/rows/rows_chunk.h"

#include "engine/chunk/block_chunk.h"
#include "engine/chunk/byte_stream.h"

#include <algorithm>
#include <bit>
#include <fmt/core.h>

namespace relume {

namespace {

// signExtend() takes the low `bits` bits of a number as a signed number. Zigzag maps 0, -1, 1, -2, … to 0, 1,
// 2, 3, ….
int32_t signExtend(uint32_t value, int bits) { return int32_t(value << (32 - bits)) >> (32 - bits); }
uint32_t zigzag(int32_t value) { return uint32_t(value) << 1 ^ uint32_t(value >> 31); }
int32_t unzigzag(uint32_t value) { return int32_t(value >> 1) ^ -int32_t(value & 1); }

static_assert(kRunHeaderBytes + kRunRows * kRunRowBytes + kRunEntries * kRunEntryBytes <= kLargestChunk);

} // namespace

uint32_t decorrelate(uint32_t packed) {
    const ivec3 value = unpackCoefficient(packed);
    const uint32_t green = zigzag(value.y);
    const uint32_t red = zigzag(signExtend(uint32_t(value.x - value.y), 11));
    const uint32_t blue = zigzag(signExtend(uint32_t(value.z - (value.y >> 1)), 10));
    return (green & 255) | (red & 255) << 8 | (blue & 255) << 16 | (green >> 8) << 24 | (red >> 8) << 27 |
           (blue >> 8) << 30;
}

uint32_t correlate(uint32_t stored) {
    const int32_t green = unzigzag((stored & 255) | (stored >> 24 & 7) << 8);
    const int32_t red = unzigzag((stored >> 8 & 255) | (stored >> 27 & 7) << 8);
    const int32_t blue = unzigzag((stored >> 16 & 255) | (stored >> 30 & 3) << 8);
    return packCoefficient({red + green, green, blue + (green >> 1)});
}

uint32_t blockVertices(int coefficients, int terms) {
    const size_t most = std::max<size_t>(kRunEntries / (size_t(coefficients) * size_t(terms)), 1);
    return std::min(kMostBlockVertices, uint32_t(std::bit_floor(most)));
}

std::vector<std::byte> encodeRun(const SparseTransport& transport, VertexRun run, uint32_t offset) {
    const size_t firstRow = size_t(run.first) * transport.terms, endRow = size_t(run.end) * transport.terms;
    const uint64_t start = transport.rowStarts[firstRow], end = transport.rowStarts[endRow];
    std::vector<uint16_t> lengths, gaps;
    std::vector<uint32_t> scales, values(end - start);
    for (size_t row = firstRow; row < endRow; row++) {
        lengths.push_back(uint16_t(transport.rowStarts[row + 1] - transport.rowStarts[row]));
        scales.push_back(std::bit_cast<uint32_t>(transport.scales[row]));
        forEachGap(std::span(transport.indices).subspan(transport.rowStarts[row], lengths.back()),
                   [&](uint16_t gap) { gaps.push_back(gap); });
    }
    for (size_t i = 0; i < values.size(); i++) values[i] = decorrelate(transport.values[start + i]);
    ByteWriter out;
    out.put(offset + run.first);
    out.put(run.end - run.first);
    out.put(uint32_t(end - start));
    out.putPlanes<uint16_t>(lengths);
    out.putPlanes<uint32_t>(scales);
    out.putPlanes<uint16_t>(gaps);
    out.putPlanes<uint32_t>(values);
    return out.take();
}

void decodeRun(std::span<const std::byte> raw, uint32_t coefficients, size_t entryLimit,
               const std::string& where, SparseTransport& transport, uint32_t offset) {
    ByteReader in(raw, where);
    const auto first = in.get<uint32_t>(), count = in.get<uint32_t>(), entries = in.get<uint32_t>();
    const size_t rowsRead = transport.rowStarts.size() - 1;
    const size_t rows = size_t(count) * transport.terms;
    if (first < offset || size_t(first - offset) * transport.terms != rowsRead ||
        rows > transport.rows() - rowsRead)
        throw Error(
            fmt::format("{}: its {} vertices from {} on do not follow those before it", where, count, first));
    if (entries > entryLimit - transport.entries() ||
        in.left() != rows * kRunRowBytes + size_t(entries) * kRunEntryBytes)
        throw Error(
            fmt::format("{}: {} bytes do not hold {} rows and {} entries", where, raw.size(), rows, entries));

    const auto lengths = in.getPlanes<uint16_t>(rows);
    const auto scales = in.getPlanes<uint32_t>(rows);
    const auto gaps = in.getPlanes<uint16_t>(entries);
    const auto values = in.getPlanes<uint32_t>(entries);
    size_t read = 0;
    for (size_t row = 0; row < rows; row++) {
        if (lengths[row] > entries - read)
            throw Error(fmt::format("{}: rows are longer than the {} entries", where, entries));
        decodeIndices(std::span(gaps).subspan(read, lengths[row]), coefficients, where, transport.indices);
        read += lengths[row];
        transport.rowStarts.push_back(transport.indices.size());
        transport.scales.push_back(std::bit_cast<float>(scales[row]));
    }
    if (read != entries) throw Error(fmt::format("{}: rows hold {} of {} entries", where, read, entries));
    transport.values.resize(transport.indices.size());
    std::ranges::transform(values, transport.values.end() - ptrdiff_t(entries), correlate);
}

void addTransport(ChunkWriter& file, uint32_t owner, const SparseTransport& transport, uint32_t block) {
    for (uint32_t run = 0; run * uint64_t(block) < transport.vertices; run++) {
        const uint32_t first = run * block, end = std::min(transport.vertices - first, block) + first;
        file.add(SparseTransport::kTag, owner, run, encodeRun(transport, {first, end}));
    }
}

void readTransport(const ChunkFile& file, uint32_t owner, uint64_t entries, uint32_t coefficients,
                   SparseTransport& transport) {
    const uint64_t bytes = transport.rows() * kRunRowBytes + entries * kRunEntryBytes;
    const auto runs = findSized(file, SparseTransport::kTag, owner, kRunHeaderBytes, bytes, "set");
    transport.rowStarts.reserve(transport.rows() + 1);
    transport.rowStarts.push_back(0);
    transport.scales.reserve(transport.rows());
    transport.indices.reserve(entries);
    transport.values.reserve(entries);
    for (const ChunkEntry& run : runs)
        decodeRun(file.load(run), coefficients, entries, whereOf(file, run, "set"), transport);
}

ChunkSizes chunkSizes(const SparseTransport& layout, uint32_t vertices, int coefficients) {
    const uint64_t rows = uint64_t(vertices) * layout.terms, least = kRunHeaderBytes + rows * kRunRowBytes;
    return {least, least + rows * uint64_t(coefficients) * kRunEntryBytes, kRunEntryBytes};
}

uint64_t memoryBytes(const SparseTransport& layout, uint32_t vertices, uint64_t rawSize) {
    // Lengths are not stored with rows in memory.
    constexpr uint64_t kLengthBytes = kRunRowBytes - sizeof(float);
    return rawSize - kRunHeaderBytes - uint64_t(vertices) * layout.terms * kLengthBytes;
}

uint64_t entriesOf(const SparseTransport& layout, uint32_t vertices, uint64_t rawSize, const LoadChunk&) {
    return (rawSize - chunkSizes(layout, vertices, 0).least) / kRunEntryBytes;
}

void checkChunk(const SparseTransport& layout, const BlockPlace& place, std::span<const std::byte> raw,
                const RowLimits& limits, const std::string& where) {
    SparseTransport rows;
    rows.vertices = place.vertices;
    rows.terms = layout.terms;
    rows.rowStarts = {0};
    // The run can have no more entries than its size allows.
    decodeRun(raw, limits.coefficients, raw.size() / kRunEntryBytes, where, rows, place.first);
    if (rows.rowStarts.size() != rows.rows() + 1)
        throw Error(fmt::format("{}: expected {} vertices, found fewer", where, rows.vertices));
    checkTransport(rows, limits.coefficients, limits.longestRow, where);
}

} // namespace relume

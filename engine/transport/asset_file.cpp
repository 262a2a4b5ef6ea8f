// From an asset to the bytes of its file and back: docs/asset_format.md.
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/transport/asset.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "engine/transport/byte_stream.h"
#include "engine/transport/chunk_file.h"
#include "engine/transport/transport_chunk.h"

#include <algorithm>
#include <cstring>

namespace relume {

namespace {

constexpr ChunkTag kMeta = chunkTag("META");
constexpr ChunkTag kOccluderPositions = chunkTag("OPOS"), kOccluderTriangles = chunkTag("OTRI");
constexpr ChunkTag kPositions = chunkTag("MPOS"), kNormals = chunkTag("MNRM"), kTriangles = chunkTag("MTRI");
constexpr ChunkTag kLightMaps = chunkTag("LMAP"), kViewMaps = chunkTag("VMAP"),
                   kEigenvalues = chunkTag("EIGV");
constexpr ChunkTag kTransport = chunkTag("TRAN");
constexpr ChunkTag kWholeTags[] = {kMeta, kOccluderPositions, kOccluderTriangles};
constexpr ChunkTag kPartTags[] = {kPositions, kNormals,     kTriangles, kLightMaps,
                                  kViewMaps,  kEigenvalues, kTransport};

// Every array but the transport is made of three 32-bit words an element.
constexpr size_t kTripleBytes = 12;
constexpr size_t kTriplesPerChunk = size_t(1) << 19;
static_assert(kTriplesPerChunk * kTripleBytes <= kLargestChunk);
static_assert(kRunHeaderBytes + kRunRows * kRunRowBytes + kRunEntries * kRunEntryBytes <= kLargestChunk);

template <typename Triple>
void addTriples(ChunkWriter& file, ChunkTag tag, uint32_t part, const std::vector<Triple>& triples) {
    static_assert(sizeof(Triple) == kTripleBytes && std::is_trivially_copyable_v<Triple>);
    for (size_t start = 0; start < triples.size(); start += kTriplesPerChunk) {
        const size_t count = std::min(kTriplesPerChunk, triples.size() - start);
        std::vector<uint32_t> words(3 * count);
        std::memcpy(words.data(), &triples[start], count * kTripleBytes);
        ByteWriter raw;
        raw.putPlanes<uint32_t>(words);
        file.add(tag, part, uint32_t(start / kTriplesPerChunk), raw.bytes());
    }
}

void addTransport(ChunkWriter& file, uint32_t part, const SparseTransport& transport) {
    VertexRun run{0, 0};
    for (uint32_t number = 0; run.end < transport.vertices; number++) {
        run = nextRun(transport, run.end);
        file.add(kTransport, part, number, encodeRun(transport, run));
    }
}

std::string whereOf(const ChunkFile& file, ChunkTag tag, uint32_t part) {
    const std::string owner = part == kWholeFile ? "" : fmt::format(" of part {}", part);
    return fmt::format("{}: chunk {}{}", file.name(), tagText(tag), owner);
}

std::string whereOf(const ChunkFile& file, const ChunkEntry& entry) {
    return fmt::format("{}, run {}", whereOf(file, entry.tag, entry.part), entry.run);
}

// Chunks of an array and, before anything is allocated for it, their sizes.
std::vector<ChunkEntry> findSized(const ChunkFile& file, ChunkTag tag, uint32_t part, uint64_t chunkBytes,
                                  uint64_t contentBytes) {
    const std::vector<ChunkEntry> runs = file.find(tag, part);
    uint64_t found = 0;
    for (const ChunkEntry& run : runs) found += run.rawSize;
    const uint64_t expected = contentBytes + chunkBytes * runs.size();
    if (found != expected)
        throw Error("{}: expected {} bytes, found {}", whereOf(file, tag, part), expected, found);
    return runs;
}

template <typename Triple>
std::vector<Triple> readTriples(const ChunkFile& file, ChunkTag tag, uint32_t part, uint64_t count) {
    const auto runs = findSized(file, tag, part, 0, count * kTripleBytes);
    std::vector<Triple> triples(count);
    size_t read = 0;
    for (const ChunkEntry& run : runs) {
        if (run.rawSize % kTripleBytes != 0)
            throw Error("{}: {} bytes are not a multiple of {}", whereOf(file, run), run.rawSize,
                        kTripleBytes);
        const std::string where = whereOf(file, run);
        const std::vector<std::byte> raw = file.load(run);
        const auto words = ByteReader(raw, where).getPlanes<uint32_t>(raw.size() / sizeof(uint32_t));
        std::memcpy(&triples[read], words.data(), raw.size());
        read += raw.size() / kTripleBytes;
    }
    return triples;
}

void readTransport(const ChunkFile& file, uint32_t part, uint64_t entries, uint32_t coefficients,
                   SparseTransport& transport) {
    const uint64_t bytes = transport.rows() * kRunRowBytes + entries * kRunEntryBytes;
    const auto runs = findSized(file, kTransport, part, kRunHeaderBytes, bytes);
    transport.rowStarts.reserve(transport.rows() + 1);
    transport.rowStarts.push_back(0);
    transport.scales.reserve(transport.rows());
    transport.indices.reserve(entries);
    transport.values.reserve(entries);
    for (const ChunkEntry& run : runs)
        decodeRun(file.load(run), coefficients, entries, whereOf(file, run), transport);
}

void readPart(const ChunkFile& file, uint32_t number, const AssetPartSizes& sizes, uint32_t coefficients,
              AssetPart& part) {
    const uint64_t texels = uint64_t(part.brdf.terms) * part.brdf.mapTexels();
    part.mesh.positions = readTriples<vec3>(file, kPositions, number, sizes.vertices);
    part.mesh.normals = readTriples<vec3>(file, kNormals, number, sizes.vertices);
    part.mesh.triangles = readTriples<uvec3>(file, kTriangles, number, sizes.triangles);
    part.brdf.lightMaps = readTriples<vec3>(file, kLightMaps, number, texels);
    part.brdf.viewMaps = readTriples<vec3>(file, kViewMaps, number, texels);
    part.brdf.eigenvalues =
        readTriples<std::array<float, 3>>(file, kEigenvalues, number, uint64_t(part.brdf.terms));
    readTransport(file, number, sizes.entries, coefficients, part.transport);
}

AssetMeta readMeta(const ChunkFile& file) {
    const auto runs = file.find(kMeta, kWholeFile);
    if (runs.size() != 1 || runs[0].rawSize > kLargestMeta)
        throw Error("{}: expected one chunk META of at most {} bytes", file.name(), kLargestMeta);
    const std::vector<std::byte> raw = file.load(runs[0]);
    return decodeMeta({reinterpret_cast<const char*>(raw.data()), raw.size()}, file.name());
}

// Whether every required chunk is one that this program reads, of a part that there is.
void checkTags(const ChunkFile& file, size_t parts) {
    for (const ChunkEntry& entry : file.entries()) {
        if (!isRequired(entry.tag)) continue;
        const bool known = entry.part == kWholeFile
                               ? std::ranges::find(kWholeTags, entry.tag) != std::end(kWholeTags)
                               : std::ranges::find(kPartTags, entry.tag) != std::end(kPartTags);
        if (!known)
            throw Error(
                "{}: is not a chunk that this program knows, and needed to read the file; update the program "
                "or bake again",
                whereOf(file, entry));
        if (entry.part != kWholeFile && entry.part >= parts)
            throw Error("{}: the file has {} parts", whereOf(file, entry), parts);
    }
}

} // namespace

std::vector<std::byte> encodeAsset(const Asset& asset) {
    checkAsset(asset, "the bake");
    ChunkWriter file;
    const std::string meta = encodeMeta(asset);
    file.add(kMeta, kWholeFile, 0, std::as_bytes(std::span(meta)));
    addTriples(file, kOccluderPositions, kWholeFile, asset.occluder.positions);
    addTriples(file, kOccluderTriangles, kWholeFile, asset.occluder.triangles);
    for (uint32_t number = 0; number < asset.parts.size(); number++) {
        const AssetPart& part = asset.parts[number];
        addTriples(file, kPositions, number, part.mesh.positions);
        addTriples(file, kNormals, number, part.mesh.normals);
        addTriples(file, kTriangles, number, part.mesh.triangles);
        addTriples(file, kLightMaps, number, part.brdf.lightMaps);
        addTriples(file, kViewMaps, number, part.brdf.viewMaps);
        addTriples(file, kEigenvalues, number, part.brdf.eigenvalues);
        addTransport(file, number, part.transport);
    }
    return file.finish();
}

Asset decodeAsset(std::span<const std::byte> bytes, const std::string& name) {
    const ChunkFile file(bytes, name);
    AssetMeta meta = readMeta(file);
    Asset& asset = meta.asset;
    checkTags(file, asset.parts.size());
    asset.occluder.positions = readTriples<vec3>(file, kOccluderPositions, kWholeFile, meta.occluderVertices);
    asset.occluder.triangles =
        readTriples<uvec3>(file, kOccluderTriangles, kWholeFile, meta.occluderTriangles);
    const auto coefficients = uint32_t(6 * asset.faceSize * asset.faceSize);
    for (uint32_t number = 0; number < asset.parts.size(); number++)
        readPart(file, number, meta.sizes[number], coefficients, asset.parts[number]);
    checkAsset(asset, name);
    return std::move(meta.asset);
}

void writeAsset(const std::filesystem::path& path, const Asset& asset) {
    writeFileAtomically(path, encodeAsset(asset));
}

Asset readAsset(const std::filesystem::path& path) { return decodeAsset(readFile(path), path.string()); }

} // namespace relume

// Encodes and decodes asset files: docs/asset_format.md.
#include "engine/transport/asset_file.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/chunk/byte_stream.h"
#include "engine/transport/asset.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "engine/transport/layout_chunks.h"

#include <algorithm>
#include <cstring>
#include <fmt/core.h>
#include <map>

namespace relume {

namespace {

constexpr ChunkTag kWholeTags[] = {kMeta, kOccluderPositions, kOccluderTriangles};
constexpr ChunkTag kPartTags[] = {kPositions, kNormals,   kTriangles,   kUvs,       kColors,
                                  kTangents,  kBaseColor, kMaterialMap, kNormalMap, kEmissionMap};
constexpr ChunkTag kShardTags[] = {kShard, kBlockLosses}; // of the whole file, too
constexpr ChunkTag kSetTags[] = {kLightMaps,       kViewMaps,          kEigenvalues,
                                 kResidualKernels, kIrradianceWeights, kDirectShares};

bool isIn(ChunkTag tag, std::span<const ChunkTag> tags) { return std::ranges::find(tags, tag) != tags.end(); }
bool isOfSet(ChunkTag tag) { return isIn(tag, kSetTags) || isLayoutTag(tag); }
const char* ownerOf(ChunkTag tag) { return isOfSet(tag) ? "set" : "part"; }

// Every array but the transport has elements of one to four 32-bit words.
constexpr size_t kElementsPerChunk = size_t(1) << 19;
static_assert(kElementsPerChunk * sizeof(vec4) <= kLargestChunk);

template <typename Element>
void addArray(ChunkWriter& file, ChunkTag tag, uint32_t owner, const std::vector<Element>& elements) {
    static_assert(sizeof(Element) % 4 == 0 && sizeof(Element) <= 16 && std::is_trivially_copyable_v<Element>);
    for (size_t start = 0; start < elements.size(); start += kElementsPerChunk) {
        const size_t count = std::min(kElementsPerChunk, elements.size() - start);
        std::vector<uint32_t> words(count * sizeof(Element) / 4);
        std::memcpy(words.data(), &elements[start], count * sizeof(Element));
        ByteWriter raw;
        raw.putPlanes<uint32_t>(words);
        file.add(tag, owner, uint32_t(start / kElementsPerChunk), raw.bytes());
    }
}

template <typename Element>
std::vector<Element> readArray(const ChunkFile& file, ChunkTag tag, uint32_t owner, uint64_t count) {
    const auto runs = findSized(file, tag, owner, 0, count * sizeof(Element), ownerOf(tag));
    std::vector<Element> elements(count);
    size_t read = 0;
    for (const ChunkEntry& run : runs) {
        const std::string where = whereOf(file, run, ownerOf(tag));
        if (run.rawSize % sizeof(Element) != 0)
            throw Error(
                fmt::format("{}: {} bytes are not a multiple of {}", where, run.rawSize, sizeof(Element)));
        const std::vector<std::byte> raw = file.load(run);
        const auto words = ByteReader(raw, where).getPlanes<uint32_t>(raw.size() / sizeof(uint32_t));
        std::memcpy(&elements[read], words.data(), raw.size());
        read += raw.size() / sizeof(Element);
    }
    return elements;
}

void readPart(const ChunkFile& file, uint32_t number, const AssetPartSizes& sizes, AssetPart& part) {
    part.mesh.positions = readArray<vec3>(file, kPositions, number, sizes.vertices);
    part.mesh.normals = readArray<vec3>(file, kNormals, number, sizes.vertices);
    part.mesh.triangles = readArray<uvec3>(file, kTriangles, number, sizes.triangles);
    part.mesh.uvs = readArray<vec2>(file, kUvs, number, sizes.uvs);
    part.mesh.colors = readArray<vec4>(file, kColors, number, sizes.colors);
    part.mesh.tangents = readArray<vec3>(file, kTangents, number, sizes.tangents);
    const auto readTexels = [&](ChunkTag tag, Texture& texture) {
        texture.texels = readArray<uint32_t>(file, tag, number, texture.texelCount());
    };
    if (part.baseColor) readTexels(kBaseColor, *part.baseColor);
    if (part.materialMap) readTexels(kMaterialMap, *part.materialMap);
    if (part.detail.normalMap) readTexels(kNormalMap, *part.detail.normalMap);
    if (part.detail.emissionMap) readTexels(kEmissionMap, *part.detail.emissionMap);
}

void readFactors(const ChunkFile& file, uint32_t number, MaterialSet& set) {
    const uint64_t texels = uint64_t(set.brdf.terms) * set.brdf.mapTexels();
    set.brdf.lightMaps = readArray<vec3>(file, kLightMaps, number, texels);
    set.brdf.viewMaps = readArray<vec3>(file, kViewMaps, number, texels * uint64_t(set.brdf.layers));
    set.brdf.eigenvalues =
        readArray<std::array<float, 3>>(file, kEigenvalues, number, uint64_t(set.brdf.terms));
}

// Maps residuals without values to the same with values.
using Residuals = std::map<std::shared_ptr<const ResidualSet>, std::shared_ptr<const ResidualSet>>;

// Reads the values of a residual unless an earlier set shared it.
void readResidual(const ChunkFile& file, uint32_t number, bool isBounced, Residuals& residuals,
                  MaterialSet& set) {
    if (!set.residual) return;
    std::shared_ptr<const ResidualSet>& read = residuals[set.residual];
    if (!read) {
        uint64_t count = 0;
        for (const auto& kernel : set.residual->layers) count += kernel->valueCount();
        const auto values = readArray<vec3>(file, kResidualKernels, number, count);
        const auto residual = std::make_shared<ResidualSet>();
        auto next = values.begin();
        for (const auto& empty : set.residual->layers) {
            const auto kernel = std::make_shared<SphereKernel>(*empty);
            kernel->values.assign(next, next + ptrdiff_t(empty->valueCount()));
            next += ptrdiff_t(empty->valueCount());
            residual->layers.push_back(kernel);
        }
        residual->hasNonnegativeTerms = isNonnegative(set.brdf);
        residual->isBounced = isBounced;
        residual->irradianceWeights =
            readArray<vec3>(file, kIrradianceWeights, number, uint64_t(set.brdf.terms));
        read = residual;
    }
    set.residual = read;
}

// Throws if the set has transport in another layout than its own.
void expectNoOtherLayout(const ChunkFile& file, uint32_t set, TransportLayout own) {
    for (const LayoutFacts& other : kLayoutFacts)
        if (other.tag != layoutTag(own) && !file.find(other.tag, set).empty())
            throw Error(fmt::format("{}: expected none in a set of the layout {}; the file is damaged",
                                    whereOf(file, other.tag, set, "set"), layoutName(own)));
}

AssetMeta readMeta(const ChunkFile& file) {
    const auto runs = file.find(kMeta, kWholeFile);
    if (runs.size() != 1 || runs[0].rawSize > kLargestMeta)
        throw Error(
            fmt::format("{}: expected one chunk META of at most {} bytes", file.name(), kLargestMeta));
    return decodeMeta(file.load(runs[0]), file.name());
}

// Throws unless every required chunk is one that this program reads, and belongs to an existing part or set.
void checkTags(const ChunkFile& file, AssetFileKind kind, size_t parts, size_t sets) {
    const bool isShard = file.findRun(kShard, kWholeFile, 0);
    if (isShard && kind == AssetFileKind::Bake)
        throw Error(
            fmt::format("{}: is a shard of a bake, not a whole one; join all its shards with `relume merge`",
                        file.name()));
    if (!isShard && kind == AssetFileKind::Shard)
        throw Error(fmt::format(
            "{}: is a whole bake, not a shard of one; shards are made with `relume bake --shard I/N`",
            file.name()));
    for (const ChunkEntry& entry : file.entries()) {
        if (!isRequired(entry.tag)) continue;
        const bool ofSet = isOfSet(entry.tag);
        const bool known = entry.owner == kWholeFile
                               ? isIn(entry.tag, kWholeTags) || (isShard && isIn(entry.tag, kShardTags))
                               : ofSet || isIn(entry.tag, kPartTags);
        if (!known)
            throw Error(fmt::format(
                "{}: is not a chunk that this program knows, and needed to read the file; update the program "
                "or bake again",
                whereOf(file, entry, ownerOf(entry.tag))));
        if (entry.owner != kWholeFile && entry.owner >= (ofSet ? sets : parts))
            throw Error(fmt::format("{}: the file has {} {}", whereOf(file, entry, ownerOf(entry.tag)),
                                    ofSet ? sets : parts, ofSet ? "sets" : "parts"));
    }
}

} // namespace

void addChunks(ChunkWriter& file, const Asset& asset, std::span<const uint64_t> setEntries,
               const std::function<void(uint32_t set)>& addTransport, const std::string& visibilityKey) {
    file.add(kMeta, kWholeFile, 0, encodeMeta(asset, sizesOf(asset, setEntries), visibilityKey));
    forEachArray(
        asset,
        [&](ChunkTag tag, uint32_t owner, const auto& elements) { addArray(file, tag, owner, elements); },
        [&](uint32_t number, const MaterialSet&) { addTransport(number); });
}

static ChunkWriter chunksOf(const Asset& asset) {
    checkAsset(asset, "the bake");
    std::vector<const Transport*> transports;
    std::vector<uint64_t> entries;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets) {
            transports.push_back(&set.transport);
            entries.push_back(entriesOf(set.transport));
        }
    ChunkWriter file;
    const uint32_t block = blockVertices(asset);
    addChunks(file, asset, entries, [&](uint32_t set) {
        std::visit([&](const auto& kept) { addTransport(file, set, kept, block); }, *transports[set]);
    });
    return file;
}

std::vector<std::byte> encodeAsset(const Asset& asset) { return chunksOf(asset).finish(); }

AssetMeta readMeta(const ChunkFile& file, AssetFileKind kind) {
    AssetMeta meta = readMeta(file);
    checkTags(file, kind, meta.asset.parts.size(), meta.sizes.setEntries.size());
    return meta;
}

void readArrays(const ChunkFile& file, AssetMeta& meta) {
    Asset& asset = meta.asset;
    asset.occluder.positions =
        readArray<vec3>(file, kOccluderPositions, kWholeFile, meta.sizes.occluderVertices);
    asset.occluder.triangles =
        readArray<uvec3>(file, kOccluderTriangles, kWholeFile, meta.sizes.occluderTriangles);
    uint32_t setNumber = 0;
    Residuals residuals;
    for (uint32_t number = 0; number < asset.parts.size(); number++) {
        readPart(file, number, meta.sizes.parts[number], asset.parts[number]);
        for (MaterialSet& set : asset.parts[number].sets) {
            readFactors(file, setNumber, set);
            readResidual(file, setNumber, asset.bounces > 0, residuals, set);
            if (!file.find(kDirectShares, setNumber).empty())
                set.directShares = readArray<uint32_t>(file, kDirectShares, setNumber,
                                                       meta.sizes.parts[number].vertices * set.shareWords());
            setNumber++;
        }
    }
}

Asset decodeAsset(std::span<const std::byte> bytes, const std::string& name) {
    const ChunkFile file(bytes, name);
    AssetMeta meta = readMeta(file, AssetFileKind::Bake);
    readArrays(file, meta);
    const auto coefficients = uint32_t(6 * meta.asset.faceSize * meta.asset.faceSize);
    uint32_t setNumber = 0;
    for (AssetPart& part : meta.asset.parts)
        for (MaterialSet& set : part.sets) {
            expectNoOtherLayout(file, setNumber, layoutOf(set.transport));
            std::visit(
                [&](auto& transport) {
                    readTransport(file, setNumber, meta.sizes.setEntries[setNumber], coefficients, transport);
                },
                set.transport);
            setNumber++;
        }
    checkAsset(meta.asset, name);
    return std::move(meta.asset);
}

void writeAsset(const std::filesystem::path& path, const Asset& asset) {
    AtomicFile file(path);
    chunksOf(asset).finish([&](std::span<const std::byte> bytes) { file.write(bytes); });
    file.commit();
}

Asset readAsset(const std::filesystem::path& path) { return decodeAsset(readFile(path), path.string()); }

} // namespace relume

// A small valid asset, and files of one with changed chunks but right checksums.
#pragma once

#include "engine/base/hash.h"
#include "engine/chunk/byte_stream.h"
#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"

#include <algorithm>
#include <random>

namespace relume::test {

// `perRow` entries at most, at random places; some rows are empty.
inline SparseTransport sampleTransport(uint32_t vertices, uint32_t terms, int faceSize, int perRow,
                                       std::mt19937& random) {
    SparseTransport transport;
    transport.vertices = vertices;
    transport.terms = terms;
    transport.rowStarts.push_back(0);
    std::geometric_distribution<int> gap(double(perRow) / double(6 * faceSize * faceSize));
    std::normal_distribution<float> gauss(0, 0.2f);
    for (size_t row = 0; row < transport.rows(); row++) {
        const int length = row % 7 == 3 ? 0 : perRow;
        int index = gap(random);
        for (int i = 0; i < length && index < 6 * faceSize * faceSize; i++, index += 1 + gap(random)) {
            const float gray = gauss(random);
            const vec3 value =
                glm::clamp(vec3(gray, 0.8f * gray, 0.5f * gray + 0.02f * gauss(random)), -1.0f, 1.0f);
            transport.indices.push_back(uint16_t(index));
            transport.values.push_back(packCoefficient(quantizeCoefficient(value, 1)));
        }
        transport.scales.push_back(length == 0 ? 0.0f : std::abs(gauss(random)));
        transport.rowStarts.push_back(transport.values.size());
    }
    return transport;
}

// One to three kinds a term; clusters of `columns` columns and 2 · `terms` components at most.
inline BasisTransport sampleBases(uint32_t vertices, uint32_t terms, int faceSize, uint32_t columns,
                                  std::mt19937& random) {
    BasisTransport transport;
    transport.vertices = vertices;
    transport.terms = terms;
    for (uint32_t term = 0; term < terms; term++)
        for (uint32_t kind = 0; kind <= term % 3; kind++)
            transport.kinds.push_back(
                {term, {1, 0.001f * float(int(random() % 2001) - 1000), -0.001f * float(random() % 1000)}});
    const auto coefficients = uint32_t(6 * faceSize * faceSize);
    const auto value = [&] { return int8_t(int(random() % 255) - 127); };
    for (size_t number = 0; number < transport.clusterCount(); number++) {
        BasisCluster& cluster = transport.clusters.emplace_back();
        cluster.components =
            number % 4 == 3 ? 0 : std::min(2 * terms + uint32_t(random() % 40), kMostBasisComponents);
        for (uint32_t i = 0; i < columns; i++) cluster.indices.push_back(uint16_t(random() % coefficients));
        std::ranges::sort(cluster.indices);
        const auto repeated = std::unique(cluster.indices.begin(), cluster.indices.end());
        cluster.indices.erase(repeated, cluster.indices.end());
        for (size_t i = 0; i < cluster.columns() * cluster.components; i++) cluster.basis.push_back(value());
        for (size_t kind = 0; kind < transport.kinds.size(); kind++) {
            const uint32_t count = kind % 5 == 4 ? 0 : random() % (cluster.components + 1);
            cluster.counts.push_back(uint16_t(count));
            for (uint32_t i = 0; i < count; i++) {
                cluster.scales.push_back(float(random() % 1000) * 1e-5f);
                for (uint32_t v = 0; v < transport.verticesOf(number); v++)
                    cluster.weights.push_back(value());
            }
        }
    }
    return transport;
}

inline AssetPart samplePart(uint32_t vertices, int terms, int faceSize, int perRow, std::mt19937& random) {
    std::normal_distribution<float> gauss;
    const auto point = [&] { return vec3(gauss(random), gauss(random), gauss(random)); };
    AssetPart part;
    part.name = "sample";
    MaterialSet set;
    set.materials = {{"matt", R"({"model":"lambert","albedo":[0.5,0.25,0.125]})", 0, false}};
    for (uint32_t i = 0; i < vertices; i++) {
        part.mesh.positions.push_back(point());
        part.mesh.normals.push_back(glm::normalize(point()));
        part.mesh.triangles.push_back({i, (i + 1) % vertices, uint32_t(random()) % vertices});
    }
    set.brdf.size = 4;
    set.brdf.terms = terms;
    set.brdf.mapping = DiskMapping::Polar;
    for (size_t i = 0; i < size_t(terms) * set.brdf.mapTexels(); i++) {
        set.brdf.lightMaps.push_back(point());
        set.brdf.viewMaps.push_back(point());
    }
    for (int i = 0; i < terms; i++)
        set.brdf.eigenvalues.push_back({gauss(random), -1.0f / float(i + 1), 0.0f});
    rowsOf(set.transport) = sampleTransport(vertices, uint32_t(terms), faceSize, perRow, random);
    part.sets.push_back(std::move(set));
    return part;
}

// For every layer of a BRDF, with few numbers other than 0.
inline std::shared_ptr<ResidualSet> sampleResidual(const FactoredBrdf& brdf) {
    auto residual = std::make_shared<ResidualSet>();
    for (int layer = 0; layer < brdf.layers; layer++) {
        SphereKernel kernel{.frequencies = layer % 2, .harmonics = layer / 2, .values = {}};
        kernel.values.resize(kernel.valueCount());
        for (size_t i = 0; i < kernel.values.size(); i += 97) kernel.values[i] = vec3(float(i), 1, -0.5f);
        residual->layers.push_back(std::make_shared<const SphereKernel>(kernel));
    }
    residual->hasNonnegativeTerms = isNonnegative(brdf);
    residual->irradianceWeights.assign(size_t(brdf.terms), vec3(0.5f, -2, 1));
    return residual;
}

// The size of a sample asset: vertices of its parts, of which the last is in bases, coefficients of rows, and
// columns of bases.
struct SampleSize {
    uint32_t first = 19, second = 11, bases = 300;
    int coefficients = 24;
    uint32_t columns = 60;
};

// A size that a fuzzer can read thousands of times in a second.
constexpr SampleSize kSmallSample{5, 3, 9, 6, 12};

inline Asset sampleAsset(uint32_t seed = 1, const SampleSize& size = {}) {
    std::mt19937 random(seed);
    Asset asset;
    asset.faceSize = 8;
    asset.visibilitySize = 32;
    asset.coefficients = size.coefficients;
    asset.transportSamples = 4;
    asset.visibilityOffset = 0.1f;
    asset.truncationError = 0.21f;
    asset.quantizationError = 1e-3f;
    asset.parts.push_back(samplePart(size.first, 3, asset.faceSize, asset.coefficients, random));
    asset.parts.push_back(samplePart(size.second, 1, asset.faceSize, asset.coefficients, random));
    asset.parts[1].name = "ground \xc3\xa9\"\n";
    // The first part has all that a part can have: three layers for two materials, a second set, textures.
    AssetPart& rich = asset.parts[0];
    MaterialSet& set = rich.sets[0];
    set.materials.push_back({"glossy", R"({"model":"plastic"})", 1, true});
    set.brdf.layers = 3;
    const std::vector<vec3> layer = set.brdf.viewMaps;
    for (int extra = 0; extra < 2; extra++)
        set.brdf.viewMaps.insert(set.brdf.viewMaps.end(), layer.begin(), layer.end());
    rich.sets.push_back(samplePart(size.first, 2, asset.faceSize, asset.coefficients, random).sets[0]);
    rich.sets[1].materials[0].name = "other";
    for (uint32_t i = 0; i < size.first; i++) rich.mesh.uvs.push_back({float(i) / 7, -float(i)});
    rich.baseColor = Texture{2, 3, {1, 2, 3, 4, 5, 0xff000000}, true};
    rich.materialMap = Texture{1, 1, {0x12345678}, false};
    // The second is painted by its colors.
    for (uint32_t i = 0; i < size.second; i++) asset.parts[1].mesh.colors.push_back(vec4(float(i) / 10));
    for (const vec3& normal : asset.parts[1].mesh.normals)
        asset.parts[1].mesh.tangents.push_back(tangentFrame(normal, {1, 2, 3}).s);
    asset.parts[1].paintedByColors = true;
    asset.occluder.positions = asset.parts[0].mesh.positions;
    asset.occluder.triangles = asset.parts[0].mesh.triangles;
    asset.provenance = {"relume 0.1.0", "a device", R"({"terms":3})",
                        R"([{"name":"a","file":"b","hash":"c"}])"};
    return asset;
}

// A chunk out of a file, with its content before compression.
struct RawChunk {
    ChunkTag tag;
    uint32_t part, run;
    std::vector<std::byte> raw;
};

inline std::vector<RawChunk> chunksOf(std::span<const std::byte> bytes) {
    const ChunkFile file(bytes, "sample");
    std::vector<RawChunk> chunks;
    for (const ChunkEntry& entry : file.entries())
        chunks.push_back({entry.tag, entry.owner, entry.run, file.load(entry)});
    return chunks;
}

// A file of these chunks, with right checksums.
inline std::vector<std::byte> fileOf(const std::vector<RawChunk>& chunks) {
    ChunkWriter writer;
    for (const RawChunk& chunk : chunks) writer.add(chunk.tag, chunk.part, chunk.run, chunk.raw);
    return writer.finish();
}

// Writes a little-endian number into bytes that may be too short for it.
inline void poke(std::span<std::byte> bytes, size_t offset, uint64_t value, size_t size) {
    for (size_t i = 0; i < size && offset + i < bytes.size(); i++)
        bytes[offset + i] = std::byte(value >> 8 * i);
}

// Makes every checksum right that a file's table still lets one find, whatever else is wrong with it.
inline void reseal(std::vector<std::byte>& bytes) {
    if (bytes.size() < 32) return;
    const uint32_t named = ByteReader(std::span(bytes).subspan(12), "").get<uint32_t>();
    const size_t count = std::min<size_t>(named, (bytes.size() - 32) / 48);
    for (size_t i = 0; i < count; i++) {
        const size_t entry = 32 + 48 * i;
        ByteReader in{std::span(bytes).subspan(entry + 16), ""};
        const auto offset = in.get<uint64_t>(), stored = in.get<uint64_t>();
        if (offset > bytes.size() || stored > bytes.size() - offset) continue;
        poke(bytes, entry + 40, hash64(std::span(bytes).subspan(offset, stored)), 8);
    }
    std::vector<std::byte> head(bytes.begin(), bytes.begin() + 24);
    head.insert(head.end(), bytes.begin() + 32, bytes.begin() + ptrdiff_t(32 + 48 * count));
    poke(bytes, 24, hash64(head), 8);
}

// The same with a residual, and a third part in bases.
inline Asset mixedAsset(uint32_t seed = 1, const SampleSize& size = {}) {
    Asset asset = sampleAsset(seed, size);
    std::mt19937 random(seed + 1);
    asset.parts[1].sets[0].residual = sampleResidual(asset.parts[1].sets[0].brdf);
    asset.parts.push_back(samplePart(size.bases, 2, asset.faceSize, asset.coefficients, random));
    asset.parts[2].sets[0].transport = sampleBases(size.bases, 2, asset.faceSize, size.columns, random);
    return asset;
}

} // namespace relume::test

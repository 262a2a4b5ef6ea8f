// Tests the .relume file: it round-trips, and anything malformed is refused.
#include "engine/import/asset_info.h"
#include "engine/import/old_asset.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "engine/transport/rows/rows_chunk.h"
#include "tests/support/asset_sample.h"
#include "tests/support/old_sample.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <fmt/core.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <unistd.h>

using namespace relume;
using namespace relume::test;

namespace {

void checkSameMesh(const Mesh& a, const Mesh& b) {
    CHECK(a.positions == b.positions);
    CHECK(a.normals == b.normals);
    CHECK(a.triangles == b.triangles);
}

void checkSameTexture(const std::optional<Texture>& a, const std::optional<Texture>& b) {
    REQUIRE(a.has_value() == b.has_value());
    if (!a) return;
    CHECK(a->width == b->width);
    CHECK(a->height == b->height);
    CHECK(a->srgb == b->srgb);
    CHECK(a->texels == b->texels);
}

void checkSameResidual(const ResidualSet& a, const ResidualSet& b) {
    REQUIRE(a.layers.size() == b.layers.size());
    for (size_t layer = 0; layer < a.layers.size(); layer++) {
        CHECK(a.layers[layer]->frequencies == b.layers[layer]->frequencies);
        CHECK(a.layers[layer]->harmonics == b.layers[layer]->harmonics);
        CHECK(a.layers[layer]->values == b.layers[layer]->values);
    }
    CHECK(a.hasNonnegativeTerms == b.hasNonnegativeTerms);
    CHECK(a.irradianceWeights == b.irradianceWeights);
}

void checkSameSet(const MaterialSet& a, const MaterialSet& b) {
    REQUIRE(a.materials.size() == b.materials.size());
    for (size_t i = 0; i < a.materials.size(); i++) {
        CHECK(a.materials[i].name == b.materials[i].name);
        CHECK(a.materials[i].description == b.materials[i].description);
        CHECK(a.materials[i].layer == b.materials[i].layer);
        CHECK(a.materials[i].hasBase == b.materials[i].hasBase);
    }
    CHECK(a.brdf.size == b.brdf.size);
    CHECK(a.brdf.terms == b.brdf.terms);
    CHECK(a.brdf.layers == b.brdf.layers);
    CHECK(a.brdf.mapping == b.brdf.mapping);
    CHECK(a.brdf.lightMaps == b.brdf.lightMaps);
    CHECK(a.brdf.viewMaps == b.brdf.viewMaps);
    CHECK(a.brdf.eigenvalues == b.brdf.eigenvalues);
    REQUIRE(bool(a.residual) == bool(b.residual));
    if (a.residual) checkSameResidual(*a.residual, *b.residual);
    CHECK(verticesOf(a.transport) == verticesOf(b.transport));
    CHECK(termsOf(a.transport) == termsOf(b.transport));
    REQUIRE(layoutOf(a.transport) == layoutOf(b.transport));
    if (layoutOf(a.transport) == TransportLayout::Bases) {
        const auto &c = std::get<BasisTransport>(a.transport), &d = std::get<BasisTransport>(b.transport);
        REQUIRE(c.kinds.size() == d.kinds.size());
        for (size_t kind = 0; kind < c.kinds.size(); kind++) {
            CHECK(c.kinds[kind].term == d.kinds[kind].term);
            CHECK(c.kinds[kind].color == d.kinds[kind].color);
        }
        REQUIRE(c.clusters.size() == d.clusters.size());
        for (size_t number = 0; number < c.clusters.size(); number++) {
            const BasisCluster &e = c.clusters[number], &f = d.clusters[number];
            CHECK(e.components == f.components);
            CHECK(e.indices == f.indices);
            CHECK(e.basis == f.basis);
            CHECK(e.counts == f.counts);
            CHECK(e.scales == f.scales);
            CHECK(e.weights == f.weights);
        }
        return;
    }
    CHECK(rowsOf(a.transport).rowStarts == rowsOf(b.transport).rowStarts);
    CHECK(rowsOf(a.transport).scales == rowsOf(b.transport).scales);
    CHECK(rowsOf(a.transport).indices == rowsOf(b.transport).indices);
    CHECK(rowsOf(a.transport).values == rowsOf(b.transport).values);
}

void checkSamePart(const AssetPart& a, const AssetPart& b) {
    CHECK(a.name == b.name);
    checkSameMesh(a.mesh, b.mesh);
    CHECK(a.mesh.uvs == b.mesh.uvs);
    CHECK(a.mesh.colors == b.mesh.colors);
    CHECK(a.mesh.tangents == b.mesh.tangents);
    checkSameTexture(a.baseColor, b.baseColor);
    checkSameTexture(a.materialMap, b.materialMap);
    CHECK(a.paintedByColors == b.paintedByColors);
    REQUIRE(a.sets.size() == b.sets.size());
    for (size_t i = 0; i < a.sets.size(); i++) checkSameSet(a.sets[i], b.sets[i]);
}

void checkSame(const Asset& a, const Asset& b) {
    CHECK(a.faceSize == b.faceSize);
    CHECK(a.visibilitySize == b.visibilitySize);
    CHECK(a.coefficients == b.coefficients);
    CHECK(a.transportSamples == b.transportSamples);
    CHECK(a.visibilityOffset == b.visibilityOffset);
    CHECK(a.quantizationError == b.quantizationError);
    CHECK(a.truncationError == b.truncationError);
    REQUIRE(a.layout.has_value() == b.layout.has_value());
    if (a.layout) {
        CHECK(a.layout->wantedBytes == b.layout->wantedBytes);
        CHECK(a.layout->wantedError == b.layout->wantedError);
        CHECK(a.layout->error == b.layout->error);
    }
    checkSameMesh(a.occluder, b.occluder);
    CHECK(a.provenance.program == b.provenance.program);
    CHECK(a.provenance.device == b.provenance.device);
    CHECK(a.provenance.options == b.provenance.options);
    CHECK(a.provenance.inputs == b.provenance.inputs);
    CHECK(a.provenance.bakedShare == b.provenance.bakedShare);
    REQUIRE(a.parts.size() == b.parts.size());
    for (size_t i = 0; i < a.parts.size(); i++) checkSamePart(a.parts[i], b.parts[i]);
}

// True if the file is read or refused with an Error; anything else fails the test or ends the program.
bool isRefused(std::span<const std::byte> file) {
    try {
        decodeAsset(file, "file");
        return false;
    } catch (const Error&) {
        return true;
    }
}

RawChunk& chunk(std::vector<RawChunk>& chunks, const char (&tag)[5], uint32_t part) {
    for (RawChunk& candidate : chunks)
        if (candidate.tag == chunkTag(tag) && candidate.part == part) return candidate;
    throw std::logic_error("no such chunk");
}

std::vector<RawChunk> sampleChunks() { return chunksOf(encodeAsset(sampleAsset())); }

// The sample with one chunk's content changed, all checksums right.
std::vector<std::byte> withChunk(const char (&tag)[5], uint32_t part,
                                 const std::function<void(std::vector<std::byte>&)>& change) {
    std::vector<RawChunk> chunks = sampleChunks();
    change(chunk(chunks, tag, part).raw);
    return fileOf(chunks);
}

// The sample with META changed.
std::vector<std::byte> withMeta(const std::function<void(AssetMeta&)>& change) {
    return withChunk("META", kWholeFile, [&](std::vector<std::byte>& raw) {
        AssetMeta meta = decodeMeta(raw, "sample");
        change(meta);
        raw = encodeMeta(meta.asset, meta.sizes, meta.visibilityKey);
    });
}

} // namespace

TEST_CASE("asset file: what is written is read, bit by bit, and written again the same") {
    const Asset asset = mixedAsset();
    const std::vector<std::byte> bytes = encodeAsset(asset);
    const Asset read = decodeAsset(bytes, "sample");
    checkSame(asset, read);
    CHECK(encodeAsset(asset) == bytes);
    CHECK(encodeAsset(read) == bytes);
}

TEST_CASE("asset file: on disk, and errors name the file") {
    const auto path =
        std::filesystem::temp_directory_path() / fmt::format("asset_file_test_{}.relume", getpid());
    writeAsset(path, sampleAsset());
    checkSame(readAsset(path), sampleAsset());
    std::filesystem::resize_file(path, 1000);
    CHECK_THROWS_WITH_AS(readAsset(path), doctest::Contains(path.c_str()), Error);
    std::filesystem::remove(path);
    CHECK_THROWS_AS(readAsset(path), Error);
}

TEST_CASE("asset file: details of surfaces come back") {
    Asset asset = sampleAsset();
    AssetPart& part = asset.parts[0];
    part.mesh.uvs.assign(part.mesh.vertexCount(), vec2(0.25f, 3));
    part.mesh.colors.assign(part.mesh.vertexCount(), vec4(0.5f, 1, 0, 1));
    part.paintedByColors = false;
    part.tintedByColors = true;
    part.detail.normalMap = Texture{2, 1, {0xff8080ff, 0xffff8080}};
    part.detail.normalScale = 0.75f;
    part.detail.emission = {4, 0.5f, 0};
    part.detail.emissionMap = Texture{1, 2, {1, 2}, true};
    const std::vector<std::byte> bytes = encodeAsset(asset);
    const Asset back = decodeAsset(bytes, "sample");
    const SurfaceDetail &detail = back.parts[0].detail, &none = back.parts.back().detail;
    CHECK(back.parts[0].tintedByColors);
    REQUIRE(detail.normalMap);
    CHECK(detail.normalMap->texels == part.detail.normalMap->texels);
    CHECK(detail.normalScale == 0.75f);
    CHECK(detail.emission == vec3(4, 0.5f, 0));
    REQUIRE(detail.emissionMap);
    CHECK(detail.emissionMap->texels == std::vector<uint32_t>{1, 2});
    CHECK(detail.emissionMap->srgb);
    if (back.parts.size() > 1) CHECK(!none.isAny());
    CHECK(encodeAsset(back) == bytes);
    part.detail.emission = {-1, 0, 0};
    CHECK_THROWS_AS(decodeAsset(encodeAsset(asset), "sample"), Error);
    part.detail.emission = vec3(1);
    part.detail.normalScale = NAN;
    CHECK_THROWS_AS(decodeAsset(encodeAsset(asset), "sample"), Error);
}

TEST_CASE("asset file: what fails its checksum is named") {
    std::vector<std::byte> bytes = encodeAsset(sampleAsset());
    bytes.back() ^= std::byte(1);
    CHECK_THROWS_WITH_AS(decodeAsset(bytes, "sample"),
                         doctest::Contains("of part or set 2 fails its checksum"), Error);
    const uint32_t chunks = uint32_t(sampleChunks().size());
    bytes = encodeAsset(sampleAsset());
    bytes[32 + 48 * chunks] ^= std::byte(1); // the first chunk
    CHECK_THROWS_WITH_AS(decodeAsset(bytes, "sample"),
                         doctest::Contains("chunk META of the file fails its checksum"), Error);
}

TEST_CASE("asset file: transport is cut into blocks, and what zstd would shrink too far is stored plainly") {
    std::mt19937 random(3);
    Asset asset = sampleAsset();
    asset.faceSize = 64;
    asset.visibilitySize = 64;
    asset.transportSamples = 1;
    AssetPart& part = asset.parts[0];
    part = samplePart(7000, 4, asset.faceSize, 5, random);
    const std::vector<std::byte> bytes = encodeAsset(asset);
    const ChunkFile file(bytes, "file");
    const auto runs = file.find(chunkTag("TRAN"), 0);
    CHECK(runs.size() == 7000 / 64 + 1);
    for (const ChunkEntry& entry : file.entries()) CHECK(entry.rawSize <= kLargestChunk);
    checkSame(decodeAsset(bytes, "file"), asset);

    // Nothing but zeros: zstd would shrink them past what a reader believes.
    const StoredChunk zeros = storeChunk(SparseTransport::kTag, 0, 0, std::vector<std::byte>(1 << 20));
    CHECK(zeros.entry.storedSize == zeros.entry.rawSize);
}

TEST_CASE("asset file: a block's size depends on coefficients and terms alone, and its rows fit a run") {
    CHECK_EQ(blockVertices(96, 4), 64u);
    CHECK_EQ(blockVertices(1024, 16), 64u);
    CHECK_EQ(blockVertices(1025, 16), 32u);
    CHECK_EQ(blockVertices(6 * 64 * 64, 32), 1u);
    for (int terms = 1; terms <= 32; terms++)
        for (int coefficients = 1; coefficients <= 6 * 64 * 64; coefficients += 97)
            CHECK_LE(size_t(blockVertices(coefficients, terms)) * size_t(terms * coefficients), kRunEntries);
    Asset asset = sampleAsset();
    CHECK_EQ(blockVertices(asset), blockVertices(24, 3));
    CHECK_EQ(visibilityRunVertices(asset), 64u);
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) set.transport = emptyTransport(TransportLayout::Bases, 1, 1);
    CHECK_EQ(blockVertices(asset), 256u);
    CHECK_EQ(visibilityRunVertices(asset), 64u);
}

TEST_CASE("asset file: what was asked of a layout, and what came of it") {
    Asset asset = sampleAsset();
    for (const LayoutRecord& layout : {LayoutRecord{60.5, {}, 0.0123}, LayoutRecord{{}, 0.058, 0}}) {
        asset.layout = layout;
        checkSame(decodeAsset(encodeAsset(asset), "file"), asset);
    }
    for (const LayoutRecord& wrong :
         {LayoutRecord{-1.0, {}, 0}, LayoutRecord{{}, 0.0, 0}, LayoutRecord{{}, {}, -1}}) {
        asset.layout = wrong;
        CHECK_THROWS_WITH_AS(encodeAsset(asset), doctest::Contains("layout"), Error);
    }
}

TEST_CASE("asset file: chunks that are stored elsewhere are copied as they are") {
    const std::vector<std::byte> bytes = encodeAsset(sampleAsset());
    const ChunkFile file(bytes, "sample");
    ChunkWriter copy;
    for (const ChunkEntry& entry : file.entries())
        copy.addStored(entry, [&bytes, entry] {
            const auto stored = std::span(bytes).subspan(entry.offset, entry.storedSize);
            return std::vector(stored.begin(), stored.end());
        });
    CHECK(copy.finish() == bytes);
}

TEST_CASE("asset file: a vertex of the most terms and coefficients is one run") {
    std::mt19937 random(4);
    Asset asset = sampleAsset();
    asset.faceSize = 64;
    asset.visibilitySize = 64;
    asset.transportSamples = 1;
    asset.coefficients = 6 * 64 * 64;
    asset.parts[0] = samplePart(2, 32, 64, 1, random);
    SparseTransport& transport = rowsOf(asset.parts[0].sets[0].transport);
    transport.indices.clear();
    for (size_t row = 0; row < transport.rows(); row++)
        for (int i = 0; i < asset.coefficients; i++) transport.indices.push_back(uint16_t(i));
    for (size_t row = 0; row <= transport.rows(); row++)
        transport.rowStarts[row] = row * uint64_t(asset.coefficients);
    transport.values.assign(transport.indices.size(), packCoefficient({-1023, 1023, -511}));
    const std::vector<std::byte> bytes = encodeAsset(asset);
    CHECK(ChunkFile(bytes, "file").find(chunkTag("TRAN"), 0).size() == 2);
    checkSame(decodeAsset(bytes, "file"), asset);
}

TEST_CASE("asset file: stored coefficients stand one to one for packed ones, gray ones have few bits") {
    std::mt19937 random(5);
    for (int i = 0; i < 100000; i++) {
        const uint32_t word = uint32_t(random());
        REQUIRE(correlate(decorrelate(word)) == word);
        REQUIRE(decorrelate(correlate(word)) == word);
    }
    for (int green = -1023; green <= 1023; green++)
        CHECK((decorrelate(packCoefficient({green, green, green >> 1})) & 0xf8ffff00u) == 0);
}

TEST_CASE("asset file: cut at any length, it is refused") {
    const std::vector<std::byte> bytes = encodeAsset(mixedAsset());
    for (size_t length = 0; length < bytes.size(); length++)
        REQUIRE(isRefused(std::span(bytes).first(length)));
    // The same with a header that agrees.
    for (size_t length = 32; length < bytes.size(); length += 7) {
        std::vector<std::byte> cut(bytes.begin(), bytes.begin() + ptrdiff_t(length));
        poke(cut, 16, length, 8);
        reseal(cut);
        REQUIRE(isRefused(cut));
    }
    std::vector<std::byte> longer = bytes;
    longer.push_back(std::byte(0));
    CHECK(isRefused(longer));
    poke(longer, 16, longer.size(), 8);
    reseal(longer);
    CHECK(isRefused(longer));
}

TEST_CASE("asset file: with any bit flipped, it is refused") {
    const std::vector<std::byte> bytes = encodeAsset(mixedAsset());
    std::mt19937 random(6);
    for (int i = 0; i < 1000; i++) {
        std::vector<std::byte> flipped = bytes;
        // The first two hundred strike the header and the table.
        flipped[random() % (i < 200 ? 400 : bytes.size())] ^= std::byte(1 << random() % 8);
        REQUIRE(isRefused(flipped));
    }
}

TEST_CASE("asset file: damage under right checksums is refused or harmless") {
    const std::vector<std::byte> bytes = encodeAsset(mixedAsset());
    const std::vector<RawChunk> chunks = chunksOf(bytes);
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < 1000; i++) {
        std::vector<std::byte> stored = bytes;
        stored[random() % (i < 200 ? 400 : bytes.size())] ^= std::byte(1 << random() % 8);
        reseal(stored);
        refused += isRefused(stored);
        std::vector<RawChunk> raw = chunks;
        std::vector<std::byte>& content = raw[random() % raw.size()].raw;
        content[random() % content.size()] ^= std::byte(1 << random() % 8);
        refused += isRefused(fileOf(raw));
    }
    CHECK(refused > 400);
    CHECK(refused < 2000);
}

TEST_CASE("asset file: foreign and later files are refused by name") {
    std::vector<std::byte> bytes = encodeAsset(sampleAsset());
    CHECK_THROWS_WITH_AS(decodeAsset({}, "empty"), doctest::Contains("not a .relume file"), Error);
    std::vector<std::byte> later = bytes;
    poke(later, 8, kAssetFormatVersion + 1, 4);
    CHECK_THROWS_WITH_AS(decodeAsset(later, "later"), doctest::Contains("format version 4"), Error);
    // A transfer in text mode turns \r\n into \n.
    bytes.erase(bytes.begin() + 6);
    CHECK_THROWS_WITH_AS(decodeAsset(bytes, "text"), doctest::Contains("not a .relume file"), Error);
}

TEST_CASE("asset file: files of version 2 are refused with the remedy, which keeps all of them") {
    Asset asset = mixedAsset();
    asset.parts[1].sets[0].residual = nullptr;
    asset.layout = LayoutRecord{60.5, {}, 0.0123};
    asset.provenance.bakedShare = 0.5f;
    const std::vector<std::byte> old = oldFileOf(asset);
    CHECK_THROWS_WITH_AS(decodeAsset(old, "old"), doctest::Contains("relume convert"), Error);
    CHECK(isOldAsset(old));
    CHECK_FALSE(isOldAsset(encodeAsset(asset)));
    CHECK_FALSE(isOldAsset({}));
    checkSame(decodeAsset(updateAsset(old, "old"), "new"), asset);
    // What is wrong with it is found.
    for (size_t length = 0; length < old.size(); length += 31)
        CHECK_THROWS_AS(updateAsset(std::span(old).first(length), "old"), Error);
    std::vector<RawChunk> chunks = chunksOf(encodeAsset(asset));
    const auto refuses = [&](const std::string& meta) {
        const auto text = std::as_bytes(std::span(meta));
        chunks[0].raw.assign(text.begin(), text.end());
        std::vector<std::byte> bytes = fileOf(chunks);
        poke(bytes, 8, 2, 4);
        reseal(bytes);
        CHECK_THROWS_AS(updateAsset(bytes, "old"), Error);
    };
    refuses("{");
    refuses("{}");
    refuses("\xff");
    refuses(R"({"faceSize":8.5})");
    refuses(std::string(500000, '['));
}

TEST_CASE("asset file: transport in clusters, and in layouts to come, is refused with the remedy") {
    std::vector<RawChunk> chunks = chunksOf(encodeAsset(sampleAsset()));
    for (RawChunk& chunk : chunks)
        if (chunk.tag == SparseTransport::kTag && chunk.part == 0) chunk.tag = chunkTag("TRCL");
    const std::vector<std::byte> meta = chunks[0].raw;
    const auto fileIn = [&](std::string_view layout) {
        const auto textOf = [](std::string_view text) {
            ByteWriter out;
            out.put(uint32_t(text.size()));
            out.put(std::as_bytes(std::span(text)));
            return out.take();
        };
        const std::vector<std::byte> rows = textOf("rows"), name = textOf(layout);
        const auto found = std::ranges::search(meta, rows);
        REQUIRE(!found.empty());
        std::vector<std::byte>& raw = chunks[0].raw;
        raw.assign(meta.begin(), found.begin());
        raw.insert(raw.end(), name.begin(), name.end());
        raw.insert(raw.end(), found.end(), meta.end());
        return fileOf(chunks);
    };
    const auto refusal = [](const auto& read) -> std::string {
        try {
            read();
        } catch (const Error& error) {
            return error.what();
        }
        return "none";
    };
    CHECK(refusal([&] { decodeAsset(fileIn("clusters"), "a.relume"); }) ==
          "a.relume: chunk META: transport is in clusters, a layout that is no longer read; bake again, or "
          "convert the file with the program that made it: relume convert FILE --layout bases -o NEW");
    CHECK(refusal([&] { decodeAsset(fileIn("cells"), "a.relume"); }) ==
          "a.relume: chunk META: transport is in the layout \"cells\", and this program knows rows and "
          "bases; the file is damaged or of a later program");
    // Chunks of it in a set that says to be in rows.
    CHECK(refusal([&] { decodeAsset(fileIn("rows"), "a.relume"); }).starts_with("a.relume: chunk TRCL of"));

    std::vector<RawChunk> old = chunksOf(encodeAsset(sampleAsset()));
    const std::vector<uint64_t> entries(3, 0);
    std::string text = oldMeta(sampleAsset(), entries);
    text.replace(text.find("\"rows\""), 6, "\"clusters\"");
    const auto bytes = std::as_bytes(std::span(text));
    old[0].raw.assign(bytes.begin(), bytes.end());
    std::vector<std::byte> file = fileOf(old);
    poke(file, 8, 2, 4);
    reseal(file);
    const std::string ofOld = refusal([&] { updateAsset(file, "b.relume"); });
    CHECK(ofOld.starts_with("b.relume: "));
    CHECK(ofOld.find("transport is in clusters, a layout that is no longer read; bake again") !=
          std::string::npos);
}

TEST_CASE("asset file: unknown chunks are skipped if optional, refused if required") {
    const std::vector<std::byte> content(100, std::byte(7));
    std::vector<RawChunk> chunks = chunksOf(encodeAsset(sampleAsset()));
    chunks.push_back({chunkTag("xNEW"), 0, 0, content});
    checkSame(decodeAsset(fileOf(chunks), "file"), sampleAsset());
    chunks.back().tag = chunkTag("XNEW");
    CHECK_THROWS_WITH_AS(decodeAsset(fileOf(chunks), "file"), doctest::Contains("chunk XNEW of part 0"),
                         Error);
    chunks.back() = {chunkTag("MPOS"), 2, 0, content};
    CHECK_THROWS_WITH_AS(decodeAsset(fileOf(chunks), "file"), doctest::Contains("the file has 2 parts"),
                         Error);
    chunks.back() = {chunkTag("MPOS"), 1, 0, content};
    CHECK_THROWS_WITH_AS(decodeAsset(fileOf(chunks), "file"), doctest::Contains("appears twice"), Error);
    chunks.back() = {chunkTag("MPOS"), 1, 2, content};
    CHECK_THROWS_WITH_AS(decodeAsset(fileOf(chunks), "file"), doctest::Contains("run 1 is missing"), Error);
    chunks.back() = {chunkTag("TRBS"), 1, 0, content};
    CHECK_THROWS_WITH_AS(decodeAsset(fileOf(chunks), "file"), doctest::Contains("of the layout rows"), Error);
}

TEST_CASE("asset file: every required chunk is missed") {
    const std::vector<RawChunk> chunks = chunksOf(encodeAsset(mixedAsset()));
    for (size_t i = 0; i < chunks.size(); i++) {
        std::vector<RawChunk> fewer = chunks;
        fewer.erase(fewer.begin() + ptrdiff_t(i));
        CHECK(isRefused(fileOf(fewer)));
    }
}

TEST_CASE("asset file: a table cannot promise what the file does not hold") {
    const std::vector<std::byte> bytes = encodeAsset(sampleAsset());
    const auto refusal = [&](size_t offset, uint64_t value, size_t size) {
        std::vector<std::byte> changed = bytes;
        poke(changed, offset, value, size);
        reseal(changed);
        try {
            decodeAsset(changed, "file");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const uint64_t huge = uint64_t(1) << 62;
    CHECK(refusal(12, 0xffffffff, 4).find("more than its") != std::string::npos);   // chunk count
    CHECK(refusal(32 + 16, huge, 8).find("expected at byte") != std::string::npos); // offset
    CHECK(refusal(32 + 24, huge, 8).find("do not fit") != std::string::npos);       // stored size
    CHECK(refusal(32 + 32, huge, 8).find("cannot stand for") != std::string::npos); // raw size
    CHECK(refusal(32 + 32, kLargestChunk + 1, 8).find("cannot stand for") != std::string::npos); // raw size
    CHECK(refusal(32 + 32, 60000, 8).find("not a zstd frame of 60000") != std::string::npos);    // raw size
    // A second chunk that lies on the first.
    CHECK(refusal(32 + 48 + 16, ByteReader(std::span(bytes).subspan(32 + 16), "").get<uint64_t>(), 8)
              .find("expected at byte") != std::string::npos);
}

TEST_CASE("asset file: absurd settings and counts are refused") {
    const auto refuses = [](const std::function<void(AssetMeta&)>& change) {
        return isRefused(withMeta(change));
    };
    const auto setOf = [](AssetMeta& meta) -> MaterialSet& { return meta.asset.parts[0].sets[0]; };
    CHECK_FALSE(refuses([](AssetMeta&) {}));
    for (const int size : {0, -8, 7, 12, 128})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.faceSize = size; }));
    for (const int size : {2048, 40, 4})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.visibilitySize = size; }));
    for (const int samples : {0, 3, 25})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.transportSamples = samples; }));
    for (const int coefficients : {0, 23, 385})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.coefficients = coefficients; }));
    for (const float error : {-0.5f, std::numeric_limits<float>::infinity(), std::nanf("")})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.truncationError = error; }));
    for (const uint64_t count : {uint64_t(0), uint64_t(18), uint64_t(20), uint64_t(0xffffffff)})
        CHECK(refuses([&](AssetMeta& meta) { meta.sizes.parts[0].vertices = count; }));
    for (const int terms : {0, 2, 4, 32, 33})
        CHECK(refuses([&](AssetMeta& meta) { setOf(meta).brdf.terms = terms; }));
    for (const int size : {3, 5, 256, 257})
        CHECK(refuses([&](AssetMeta& meta) { setOf(meta).brdf.size = size; }));
    for (const int layers : {0, 1, 2, 4, 65})
        CHECK(refuses([&](AssetMeta& meta) { setOf(meta).brdf.layers = layers; }));
    for (const uint64_t entries : {uint64_t(0), uint64_t(9), uint64_t(1) << 50})
        CHECK(refuses([&](AssetMeta& meta) { meta.sizes.setEntries[0] = entries; }));
    CHECK(refuses([&](AssetMeta& meta) { setOf(meta).materials[1].layer = 2; }));
    CHECK(refuses([&](AssetMeta& meta) { setOf(meta).materials[1].name = "matt"; }));
    CHECK(refuses([&](AssetMeta& meta) { setOf(meta).materials.clear(); }));
    CHECK(refuses([](AssetMeta& meta) { meta.sizes.parts[0].uvs = 0; }));
    CHECK(refuses([](AssetMeta& meta) { meta.sizes.parts[0].colors = 1; }));
    CHECK(refuses([](AssetMeta& meta) { meta.sizes.parts[1].tangents = 0; }));
    CHECK(refuses([](AssetMeta& meta) { meta.asset.parts[0].paintedByColors = true; }));
    for (const int width : {0, 3, 8193, -1})
        CHECK(refuses([&](AssetMeta& meta) { meta.asset.parts[0].baseColor->width = width; }));
    CHECK(refuses([](AssetMeta& meta) { meta.asset.parts[0].sets.clear(); }));
    CHECK(refuses([](AssetMeta& meta) { meta.asset.parts.clear(); }));
    CHECK(refuses([](AssetMeta& meta) { meta.visibilityKey = "0123"; }));
    CHECK(refuses([](AssetMeta& meta) { meta.asset.layout = LayoutRecord{{}, 0.0, 0}; }));
}

TEST_CASE("asset file: META of any other length or with unknown words is refused") {
    const auto refusal = [](const std::function<void(std::vector<std::byte>&)>& change) {
        try {
            decodeAsset(withChunk("META", kWholeFile, change), "file");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    std::vector<RawChunk> chunks = sampleChunks();
    const std::vector<std::byte> meta = chunk(chunks, "META", kWholeFile).raw;
    for (size_t length = 1; length < meta.size(); length++)
        REQUIRE(refusal([&](auto& raw) { raw.resize(length); }) != "accepted");
    CHECK(refusal([](auto& raw) { raw.push_back(std::byte(0)); }) != "accepted");
    const auto append = [&](const std::vector<int>& more) {
        return refusal([&](auto& raw) {
            for (const int byte : more) raw.push_back(std::byte(byte));
        });
    };
    CHECK(append({1, 0, 0, 0}) == "accepted");
    CHECK(append({0, 0, 0, 0}).find("bounces") != std::string::npos);
    CHECK(append({kMostBounces + 1, 0, 0, 0}).find("bounces") != std::string::npos);
    CHECK(append({1, 0, 0, 0, 0}) != "accepted");
    std::vector<int> noDetails = {1, 0, 0, 0};
    for (size_t part = 0; part < sampleAsset().parts.size(); part++) noDetails.insert(noDetails.end(), 15, 0);
    CHECK(append(noDetails).find("details") != std::string::npos);
    const auto replaces = [&](const std::string& from, const std::string& to) {
        return refusal([&](std::vector<std::byte>& raw) {
            const auto bytes = std::as_bytes(std::span(from));
            const auto found = std::ranges::search(raw, bytes);
            REQUIRE_FALSE(found.empty());
            std::ranges::copy(std::as_bytes(std::span(to)), found.begin());
        });
    };
    CHECK(replaces("polar-sine", "mercator!!").find("mapping") != std::string::npos);
    CHECK(replaces("rows", "cols").find("layout") != std::string::npos);
    CHECK(refusal([](auto& raw) { raw.resize(kLargestMeta + 1); }).find("META of at most") !=
          std::string::npos);
    Asset wordy = sampleAsset();
    wordy.provenance.options = std::string(size_t(2) << 20, 'x');
    CHECK_THROWS_WITH_AS(encodeAsset(wordy), doctest::Contains("provenance take"), Error);
}

TEST_CASE("asset file: bounces are kept, and residuals told of them") {
    Asset asset = sampleAsset();
    MaterialSet& set = asset.parts[0].sets[0];
    set.residual = sampleResidual(set.brdf);
    for (const int bounces : {0, 3}) {
        asset.bounces = bounces;
        const Asset read = decodeAsset(encodeAsset(asset), "file");
        CHECK(read.bounces == bounces);
        REQUIRE(read.parts[0].sets[0].residual);
        CHECK(read.parts[0].sets[0].residual->isBounced == (bounces > 0));
    }
}

TEST_CASE("asset file: polar maps of earlier files keep their radius") {
    const Asset asset = decodeAsset(withMeta([](AssetMeta& meta) {
                                        meta.asset.parts[0].sets[0].brdf.mapping =
                                            DiskMapping::EqualAreaPolar;
                                    }),
                                    "file");
    CHECK(asset.parts[0].sets[0].brdf.mapping == DiskMapping::EqualAreaPolar);
    CHECK(asset.parts[1].sets[0].brdf.mapping == DiskMapping::Polar);
}

TEST_CASE("asset file: sets share a residual in the file as in memory") {
    Asset asset = sampleAsset();
    asset.parts.push_back(asset.parts[0]);
    asset.parts[2].name = "twin";
    for (const size_t part : {size_t(0), size_t(2)})
        asset.parts[part].sets[0].residual = sampleResidual(asset.parts[part].sets[0].brdf);
    asset.parts[2].sets[0].residual = asset.parts[0].sets[0].residual;
    const std::vector<std::byte> bytes = encodeAsset(asset);
    CHECK_EQ(ChunkFile(bytes, "file").find(kResidualKernels, 0).size(), 1u);
    CHECK(ChunkFile(bytes, "file").find(kResidualKernels, 3).empty());
    const Asset read = decodeAsset(bytes, "file");
    checkSame(read, asset);
    CHECK(read.parts[0].sets[0].residual == read.parts[2].sets[0].residual);
    CHECK(encodeAsset(read) == bytes);

    Asset unlike = asset;
    unlike.parts[2].sets[0].brdf.lightMaps[0].x += 1;
    CHECK_THROWS_WITH_AS(encodeAsset(unlike), doctest::Contains("a residual shared"), Error);
    unlike = asset;
    for (const vec3& normal : unlike.parts[2].mesh.normals)
        unlike.parts[2].mesh.tangents.push_back(tangentFrame(normal, {1, 2, 3}).s);
    CHECK_THROWS_WITH_AS(encodeAsset(unlike), doctest::Contains("a residual shared"), Error);
}

TEST_CASE("asset file: residuals that do not add up are refused") {
    const auto refusal = [](const std::function<void(ResidualSet&)>& change) {
        Asset asset = sampleAsset();
        const auto residual = sampleResidual(asset.parts[0].sets[0].brdf);
        change(*residual);
        asset.parts[0].sets[0].residual = residual;
        try {
            decodeAsset(encodeAsset(asset), "file");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const auto withKernel = [](ResidualSet& residual, const std::function<void(SphereKernel&)>& change) {
        SphereKernel kernel = *residual.layers[0];
        change(kernel);
        residual.layers[0] = std::make_shared<const SphereKernel>(kernel);
    };
    CHECK(refusal([](ResidualSet&) {}) == "accepted");
    CHECK(refusal([](ResidualSet& residual) { residual.layers.pop_back(); }).find("layers of a residual") !=
          std::string::npos);
    CHECK(refusal([](ResidualSet& residual) {
              residual.irradianceWeights.pop_back();
          }).find("irradiance weights") != std::string::npos);
    CHECK(refusal([&](ResidualSet& residual) {
              withKernel(residual, [](SphereKernel& kernel) { kernel.frequencies++; });
          }).find("values of a kernel") != std::string::npos);
    CHECK(refusal([&](ResidualSet& residual) {
              withKernel(residual, [](SphereKernel& kernel) { kernel.values[7].y = std::nanf(""); });
          }).find("finite kernels") != std::string::npos);
    CHECK(refusal([&](ResidualSet& residual) {
              withKernel(residual, [](SphereKernel& kernel) {
                  kernel.harmonics = shared::kMostHarmonics + 1;
                  kernel.values.resize(kernel.valueCount());
              });
          }).find("harmonics") != std::string::npos);
    CHECK(refusal([](ResidualSet& residual) {
              residual.hasNonnegativeTerms = true;
          }).find("without negative texels") != std::string::npos);
}

TEST_CASE("asset file: a preview says how much of it is baked") {
    Asset preview = sampleAsset();
    preview.provenance.bakedShare = 0.25f;
    const std::vector<std::byte> bytes = encodeAsset(preview);
    checkSame(decodeAsset(bytes, "file"), preview);
    const auto info = nlohmann::json::parse(describeAssetJson(preview, bytes.size()));
    CHECK_EQ(info["preview"]["baked_share"], 0.25);
    CHECK_FALSE(nlohmann::json::parse(describeAssetJson(sampleAsset(), 1)).contains("preview"));
    preview.provenance.bakedShare = 1.5f;
    CHECK_THROWS_WITH_AS(encodeAsset(preview), doctest::Contains("share of baked vertices"), Error);
}

TEST_CASE("asset file: transport chunks that do not add up are refused") {
    const auto refusal = [](const std::function<void(std::vector<std::byte>&)>& change) {
        try {
            decodeAsset(withChunk("TRAN", 0, change), "file");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const auto pokes = [&](size_t offset, uint64_t value, size_t size) {
        return refusal([&](std::vector<std::byte>& raw) { poke(raw, offset, value, size); });
    };
    const size_t rows = 19 * 3, gaps = 12 + 6 * rows;
    CHECK(pokes(0, 1, 4).find("do not follow") != std::string::npos);
    CHECK(pokes(4, 20, 4).find("do not follow") != std::string::npos);
    CHECK(pokes(4, 18, 4).find("do not hold") != std::string::npos);
    CHECK(pokes(4, 0xffffffff, 4).find("do not follow") != std::string::npos);
    CHECK(pokes(8, 0xffffffff, 4).find("do not hold") != std::string::npos);
    CHECK(pokes(12, 255, 1).find("expected") != std::string::npos);
    CHECK(pokes(12 + rows, 255, 1).find("longer than") != std::string::npos);
    CHECK(pokes(12 + rows - 1, 0, 1).find("rows hold") != std::string::npos);
    const auto last = [](std::vector<std::byte>& raw) { raw.pop_back(); };
    CHECK(refusal(last).find("bytes") != std::string::npos);
    const size_t entries = rowsOf(sampleAsset().parts[0].sets[0].transport).entries();
    CHECK(pokes(gaps + entries, 2, 1).find("indices below 384") != std::string::npos);
    CHECK(pokes(12 + 2 * rows + 3 * rows, 0xffff, 2).find("scales") != std::string::npos); // negative or NaN
}

TEST_CASE("asset file: contents that make no sense are refused") {
    // The high plane of the first position's first number: 0x7f and set bits below make a NaN.
    const auto nan = withChunk("MPOS", 0, [](std::vector<std::byte>& raw) {
        for (size_t plane = 2; plane < 4; plane++)
            raw[plane * raw.size() / 4] = std::byte(plane == 3 ? 0x7f : 0xff);
    });
    CHECK_THROWS_WITH_AS(decodeAsset(nan, "file"), doctest::Contains("finite positions"), Error);
    const auto corner = withChunk("MTRI", 1, [](std::vector<std::byte>& raw) { raw[0] = std::byte(11); });
    CHECK_THROWS_WITH_AS(decodeAsset(corner, "file"), doctest::Contains("corners are vertices"), Error);
}

TEST_CASE("asset file: an asset that could not be read back is not written") {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    const auto refuses = [](const std::function<void(Asset&)>& change) {
        Asset asset = sampleAsset();
        change(asset);
        CHECK_THROWS_AS(encodeAsset(asset), Error);
    };
    refuses([](Asset& a) { a.parts.clear(); });
    refuses([](Asset& a) { a.faceSize = 16, a.visibilitySize = 8; });
    refuses([&](Asset& a) { a.visibilityOffset = nan; });
    refuses([](Asset& a) { a.occluder.triangles[3].y = 19; });
    refuses([&](Asset& a) { a.occluder.positions[3].y = infinite; });
    refuses([](Asset& a) { a.parts[0].mesh.triangles.clear(); });
    refuses([](Asset& a) { a.parts[0].mesh.normals.pop_back(); });
    refuses([](Asset& a) { a.parts[0].mesh.normals[2] *= 1.01f; });
    refuses([&](Asset& a) { a.parts[0].mesh.normals[2].x = nan; });
    refuses([&](Asset& a) { a.parts[0].sets[0].brdf.lightMaps[5].z = nan; });
    refuses([](Asset& a) { a.parts[0].sets[0].brdf.viewMaps.pop_back(); });
    refuses([&](Asset& a) { a.parts[0].sets[0].brdf.eigenvalues[0][1] = infinite; });
    refuses([](Asset& a) { a.parts[0].sets[0].brdf.mapping = DiskMapping(4); });
    refuses([](Asset& a) { a.parts[0].sets.clear(); });
    refuses([](Asset& a) { a.parts[0].sets[0].materials.clear(); });
    refuses([](Asset& a) { a.parts[0].sets[0].materials[1].layer = 0; });
    refuses([](Asset& a) { a.parts[0].sets[0].materials.pop_back(); }); // two layers of nobody
    refuses([](Asset& a) { a.parts[0].sets[0].materials[0].name = "a\x1b[2J"; });
    refuses([](Asset& a) { a.parts[0].baseColor.reset(); });
    refuses([](Asset& a) { a.parts[0].baseColor->texels.pop_back(); });
    refuses([&](Asset& a) { a.parts[0].mesh.uvs[3].x = nan; });
    refuses([](Asset& a) { a.parts[0].mesh.uvs.pop_back(); });
    refuses([](Asset& a) { a.parts[1].mesh.colors[2].y = 1.5f; });
    refuses([](Asset& a) { a.parts[1].mesh.tangents.pop_back(); });
    refuses([](Asset& a) { a.parts[1].mesh.tangents[3] *= 1.01f; });
    refuses([](Asset& a) { a.parts[1].mesh.tangents[3] = a.parts[1].mesh.normals[3]; });
    refuses([&](Asset& a) { a.parts[1].mesh.tangents[3].x = nan; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).terms = 2; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).vertices = 18; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).rowStarts[1] = 1000000; });
    refuses([](Asset& a) {
        std::swap(rowsOf(a.parts[0].sets[0].transport).rowStarts[1],
                  rowsOf(a.parts[0].sets[0].transport).rowStarts[2]);
    });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).rowStarts.pop_back(); });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).scales[0] = -1; });
    refuses([](Asset& a) {
        rowsOf(a.parts[0].sets[0].transport).indices[1] = rowsOf(a.parts[0].sets[0].transport).indices[0];
    });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).indices.back() = 384; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).values[0] = 0x400; });       // red -1024
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).values[0] = 0x80000000u; }); // blue -512
}

TEST_CASE("asset info: JSON with the numbers that matter, whatever text the asset carries") {
    Asset asset = sampleAsset();
    auto info = nlohmann::json::parse(describeAssetJson(asset, 12345));
    const SparseTransport& transport = rowsOf(asset.parts[0].sets[0].transport);
    CHECK(info["file_bytes"] == 12345);
    CHECK(info["coefficients"] == 24);
    CHECK(info["occluder_triangles"] == 19);
    CHECK(info["parts"][0]["vertices"] == 19);
    CHECK(info["parts"][0]["sets"][0]["terms"] == 3);
    CHECK(info["parts"][0]["sets"][0]["layout"] == "rows");
    CHECK(info["parts"][0]["sets"][0]["bytes_per_vertex"] ==
          double(6 * transport.entries() + 4 * transport.rows()) / 19);
    CHECK(info["parts"][0]["sets"][0]["materials"][0]["brdf"]["model"] == "lambert");
    CHECK(info["total"]["vertices"] == 30);
    CHECK(info["provenance"]["options"]["terms"] == 3);
    asset.transportSamples = 1;
    // Would overflow the stack of a recursive printer.
    asset.parts[0].sets[0].materials[0].description = std::string(500000, '[');
    asset.parts[1].name = "\xff\xfe";
    info = nlohmann::json::parse(describeAssetJson(asset, 0));
    CHECK(info["parts"][0]["sets"][0]["materials"][0]["brdf"].is_string());
    for (const char* expected :
         {"direct alone, even over each of 6 x 8² texels", "6 x 32² directions", "linear, of unknown error",
          "one evaluation per lighting texel", "BRDF terms: of an unknown factorization",
          "coefficients of a vertex and term"})
        CHECK_MESSAGE(info["approximations"].dump().find(expected) != std::string::npos, expected);
}

// Tests the .relume file: what is written is read, bit by bit.
#include "engine/import/asset_info.h"
#include "engine/import/old_asset.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/rows/rows_chunk.h"
#include "tests/support/asset_sample.h"
#include "tests/support/old_sample.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <fmt/core.h>
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

TEST_CASE("asset file: shares of direct light are kept, and refused where they do not fit") {
    Asset asset = sampleAsset();
    MaterialSet& set = asset.parts[0].sets[0];
    const size_t words = asset.parts[0].mesh.vertexCount() * set.shareWords();
    for (size_t i = 0; i < words; i++) set.directShares.push_back(uint32_t(0x01020380 + i));
    CHECK(set.directShare(0, 0) == doctest::Approx(128.0 / 255));
    CHECK_THROWS_WITH_AS(encodeAsset(asset), doctest::Contains("only where light bounces"), Error);
    asset.bounces = 1;
    CHECK(decodeAsset(encodeAsset(asset), "file").parts[0].sets[0].directShares == set.directShares);
    set.directShares.pop_back();
    CHECK_THROWS_WITH_AS(encodeAsset(asset), doctest::Contains("shares of direct light"), Error);
    set.directShares.clear();
    CHECK(set.directShare(0, 0) == 1);
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

// Tests .relume files that were altered: what is malformed is refused, whatever else is right.
#include "engine/import/old_asset.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_meta.h"
#include "engine/transport/rows/rows_chunk.h"
#include "tests/support/asset_sample.h"
#include "tests/support/failure.h"
#include "tests/support/old_sample.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <functional>

using namespace relume;
using namespace relume::test;

namespace {

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
        const auto found = std::search(meta.begin(), meta.end(), rows.begin(), rows.end());
        REQUIRE(found != meta.end());
        std::vector<std::byte>& raw = chunks[0].raw;
        raw.assign(meta.begin(), found);
        raw.insert(raw.end(), name.begin(), name.end());
        raw.insert(raw.end(), found + std::ptrdiff_t(rows.size()), meta.end());
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

TEST_CASE("asset file: arrays are cut between their elements") {
    std::vector<RawChunk> chunks = sampleChunks();
    const RawChunk whole = chunk(chunks, "MPOS", 0);
    std::erase_if(chunks,
                  [](const RawChunk& each) { return each.tag == chunkTag("MPOS") && each.part == 0; });
    for (uint32_t run = 0; run * 5 < whole.raw.size(); run++) {
        const auto first = whole.raw.begin() + ptrdiff_t(5 * run);
        const auto end = whole.raw.begin() + ptrdiff_t(std::min<size_t>(5 * run + 5, whole.raw.size()));
        chunks.push_back({whole.tag, whole.part, run, {first, end}});
    }
    const std::vector<std::byte> file = fileOf(chunks);
    CHECK(says(failureOf([&] { decodeAsset(file, "file"); }), "not a multiple of 12"));
}

TEST_CASE("asset file: META of the version before must have every member, of its type") {
    const std::vector<uint64_t> entries(3, 0);
    const auto refusal = [&](const std::function<void(OrderedJson&)>& change) {
        OrderedJson meta = OrderedJson::parse(oldMeta(sampleAsset(), entries));
        change(meta);
        const std::string text = meta.dump();
        std::vector<RawChunk> chunks = sampleChunks();
        const auto bytes = std::as_bytes(std::span(text));
        chunks[0].raw.assign(bytes.begin(), bytes.end());
        std::vector<std::byte> file = fileOf(chunks);
        poke(file, 8, kAssetFormatVersion - 1, 4);
        reseal(file);
        return failureOf([&] { updateAsset(file, "old"); });
    };
    const OrderedJson whole = OrderedJson::parse(oldMeta(sampleAsset(), entries));
    for (const auto& item : whole.items()) {
        const std::string& member = item.key();
        CAPTURE(member);
        CHECK(says(refusal([&](OrderedJson& meta) { meta.erase(member); }), "expected a member \"" + member));
        for (const OrderedJson& other : {OrderedJson("text"), OrderedJson::array({1})})
            CHECK(refusal([&](OrderedJson& meta) { meta[member] = other; }).starts_with("old: "));
    }
    std::vector<RawChunk> chunks = sampleChunks();
    chunks.erase(chunks.begin());
    std::vector<std::byte> file = fileOf(chunks);
    poke(file, 8, kAssetFormatVersion - 1, 4);
    reseal(file);
    CHECK(says(failureOf([&] { updateAsset(file, "old"); }), "expected one chunk META"));
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
            const auto found = std::search(raw.begin(), raw.end(), bytes.begin(), bytes.end());
            REQUIRE(found != raw.end());
            std::ranges::copy(std::as_bytes(std::span(to)), found);
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

TEST_CASE("asset file: polar maps of earlier files keep their radius") {
    const Asset asset = decodeAsset(withMeta([](AssetMeta& meta) {
                                        meta.asset.parts[0].sets[0].brdf.mapping =
                                            DiskMapping::EqualAreaPolar;
                                    }),
                                    "file");
    CHECK(asset.parts[0].sets[0].brdf.mapping == DiskMapping::EqualAreaPolar);
    CHECK(asset.parts[1].sets[0].brdf.mapping == DiskMapping::Polar);
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
    CHECK(says(refusal([](ResidualSet& residual) { residual.irradianceWeights[0].y = std::nanf(""); }),
               "finite irradiance weights"));
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

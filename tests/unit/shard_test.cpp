#include "engine/transport/asset_arrays.h"
#include "precompute/bake/shard.h"
#include "tests/support/failure.h"
#include "tests/support/shard_sample.h"

#include <algorithm>
#include <bit>
#include <doctest/doctest.h>
#include <limits>

using namespace relume;
using namespace relume::test;

namespace {

// What merging says of files it refuses; empty where it does not.
std::string refusal(const std::vector<Bytes>& files) {
    try {
        merged(files);
    } catch (const Error& failure) {
        return failure.what();
    }
    return "";
}

Bytes wholeBake(const Asset& asset, TransportLayout layout = TransportLayout::Rows) {
    BakePlan plan = planIn(asset, layout);
    const SampleBlocks blocks(plan, asset);
    Bytes whole;
    writeBake(plan, blocks, appendTo(whole));
    return whole;
}

// The file with one chunk's content changed and right checksums.
Bytes edited(const Bytes& file, ChunkTag tag, const std::function<void(std::vector<std::byte>&)>& edit) {
    std::vector<RawChunk> chunks = chunksOf(file);
    edit(std::ranges::find(chunks, tag, &RawChunk::tag)->raw);
    return fileOf(chunks);
}

Bytes withText(const Bytes& file, const std::string& from, const std::string& to) {
    return edited(file, kMeta, [&](std::vector<std::byte>& raw) {
        std::string text(reinterpret_cast<const char*>(raw.data()), raw.size());
        text.replace(text.find(from), from.size(), to);
        const auto bytes = std::as_bytes(std::span(text));
        raw.assign(bytes.begin(), bytes.end());
    });
}

} // namespace

TEST_CASE("shard: \"I/N\" counts from 0, and says so") {
    CHECK(parseShard("0/1") == Shard{0, 1});
    CHECK(parseShard("3/4") == Shard{3, 4});
    CHECK(parseShard("0/1000000") == Shard{0, 1000000});
    for (const char* wrong : {"", "1", "/", "/4", "1/", "1/0", "-1/4", "1/-4", "1/4x", " 1/4", "1/ 4", "a/b",
                              "1//4", "1/4/4", "0/1000001", "0/4294967297", "4294967296/4294967297"}) {
        CAPTURE(wrong);
        CHECK_THROWS_WITH_AS(parseShard(wrong), doctest::Contains("expected I/N"), UsageError);
    }
    CHECK_THROWS_WITH_AS(parseShard("4/4"), doctest::Contains("the first of 4 is 0/4, the last 3/4"),
                         UsageError);
}

TEST_CASE("shard: every block is of one shard") {
    for (uint32_t count : {1, 2, 4, 7, 9}) {
        for (uint32_t blocks : {1, 7, 8}) {
            std::vector<int> owners(blocks, 0);
            for (uint32_t index = 0; index < count; index++) {
                const Shard shard{index, count};
                uint32_t own = 0;
                for (uint32_t block = 0; block < blocks; block++)
                    if (shard.has(block)) owners[block]++, own++;
                CHECK_EQ(own, shard.size(blocks));
            }
            CHECK(std::ranges::all_of(owners, [](int number) { return number == 1; }));
        }
    }
}

TEST_CASE("merge: shards in any order give the bytes of the whole bake") {
    const Asset asset = shardedAsset();
    const Bytes whole = wholeBake(asset);
    REQUIRE_EQ(planOf(asset).blocks.size(), 7);
    const Asset read = decodeAsset(whole, "whole");
    CHECK_EQ(read.truncationError, doctest::Approx(std::sqrt(0.1)));
    CHECK_GT(read.quantizationError, 0);
    std::mt19937 random(3);
    for (uint32_t count : {1, 2, 4, 7, 10}) {
        CAPTURE(count);
        std::vector<Bytes> files = shardsOf(asset, count);
        CHECK(merged(files) == whole);
        std::ranges::reverse(files);
        CHECK(merged(files) == whole);
        std::ranges::shuffle(files, random);
        CHECK(merged(files) == whole);
    }
}

TEST_CASE("merge: of shards in bases too") {
    const Asset asset = shardedAsset();
    constexpr TransportLayout kLayout = TransportLayout::Bases;
    const Bytes whole = wholeBake(asset, kLayout);
    REQUIRE_EQ(planIn(asset, kLayout).blocks.size(), 3u);
    const Asset read = decodeAsset(whole, "whole");
    CHECK(layoutOf(read.parts[0].sets[1].transport) == kLayout);
    REQUIRE(read.layout);
    CHECK_GT(read.layout->error, 0);
    CHECK_LT(read.layout->error, 0.1);
    for (uint32_t count : {1, 2, 4, 20}) CHECK(merged(shardsOf(asset, count, kLayout)) == whole);
    const std::string other = refusal({shardsOf(asset, 2)[0], shardsOf(asset, 2, kLayout)[1]});
    CHECK(says(other, "1: is a shard of another bake than 0: "));
}

TEST_CASE("merge: kinds that a reader would refuse are refused") {
    const Asset asset = shardedAsset();
    BakePlan bad = planIn(asset, TransportLayout::Bases);
    auto& kinds = std::get<BasisTransport>(bad.asset.parts[0].sets[0].transport).kinds;
    REQUIRE_GT(kinds.size(), 1);
    std::swap(kinds.front(), kinds.back());
    BakePlan plan = planOf(bad.asset);
    plan.scale = bad.scale;
    const SampleBlocks blocks(plan, asset);
    std::vector<Bytes> files(2);
    for (uint32_t index = 0; index < 2; index++) writeShard(plan, {index, 2}, blocks, appendTo(files[index]));
    CHECK(says(refusal(files), "0: transport of part \"sample\": expected kinds by rising term"));
}

TEST_CASE("merge: missing, doubled and strange shards are named") {
    const Asset asset = shardedAsset();
    const std::vector<Bytes> files = shardsOf(asset, 4);
    CHECK_THROWS_AS(mergeShards({}, nullptr), UsageError);
    CHECK(says(refusal({files[0], files[2], files[3]}), "1 of 4 shards missing: 1/4"));
    CHECK(says(refusal({files[3]}), "3 of 4 shards missing: 0/4, 1/4, 2/4;"));
    CHECK(says(refusal({files[0], files[1], files[2], files[3], files[2]}), "4: is shard 2/4, and so is 2"));
    CHECK(says(refusal({files[0], files[1], files[1], files[3]}), "2: is shard 1/4, and so is 1"));
    CHECK(says(refusal({files[0], shardsOf(asset, 2)[1]}), "1: is one of 2 shards, and 0 is one of 4"));
    CHECK(says(refusal({files[0], wholeBake(asset)}), "1: is a whole bake"));
    CHECK(says(refusal({files[0], Bytes(500, std::byte(7))}), "1: not a .relume file"));
    const Bytes many = edited(files[0], kShard, [](auto& raw) { poke(raw, 4, kMostShards, 4); });
    CHECK(says(refusal({many}), "999999 of 1000000 shards missing: 1/1000000, 2/1000000"));
    CHECK_THROWS_WITH_AS(decodeAsset(files[0], "part"), doctest::Contains("relume merge"), Error);
}

TEST_CASE("merge: shards of different bakes are refused, and what differs is named") {
    const Asset asset = shardedAsset();
    const std::vector<Bytes> files = shardsOf(asset, 2);
    const auto refusalOf = [&](const std::function<void(Asset&)>& change) {
        Asset other = asset;
        change(other);
        const std::string said = refusal({files[0], shardsOf(other, 2)[1]});
        CHECK(says(said, "1: is a shard of another bake than 0: "));
        return said;
    };
    CHECK(says(refusalOf([](Asset& other) { other.provenance.program = "relume 9"; }),
               "0: program: \"relume 9\", not \"relume 0.1.0\";"));
    CHECK(says(refusalOf([](Asset& other) { other.provenance.device = "another\nGPU"; }),
               "0: device: \"another GPU\", not \"a device\";"));
    CHECK(says(refusalOf([](Asset& other) { other.provenance.options = R"({"terms":4,"more":"x"})"; }),
               "0: option \"more\": \"x\", not \"nothing\"; option \"terms\": \"4\", not \"3\";"));
    CHECK(says(refusalOf([](Asset& other) { other.provenance.options = std::string(5000, '['); }),
               "0: option \"terms\": \"nothing\", not \"3\";"));
    CHECK(says(refusalOf([](Asset& other) { other.provenance.inputs = R"([{"file":"b","hash":"d"}])"; }),
               "0: input \"b\": its content;"));
    CHECK(says(refusalOf([](Asset& other) { other.provenance.inputs = R"([{"file":"c"},{"file":"d"}])"; }),
               "0: input: \"c\", not \"b\"; input: \"d\", not \"nothing\";"));
    CHECK(says(refusalOf([](Asset& other) { other.parts[0].sets[0].materials[0].name = "wood"; }),
               "0: materials: \"sample: wood other"));
    CHECK(says(refusalOf([](Asset& other) { other.parts[0].sets[0].materials[0].description = "{}"; }),
               "0: materials: what they are made of;"));
    CHECK(says(refusalOf([](Asset& other) { other.parts[0].mesh.positions[7].x += 1; }), "0: the meshes;"));
    CHECK(says(refusalOf([](Asset& other) { other.occluder.positions[7].x += 1; }), "0: the occluder;"));
    CHECK(says(refusalOf([](Asset& other) { other.parts[1].sets[0].brdf.lightMaps[0].x += 1; }),
               "0: the materials' factors;"));
    // A part whose text was edited keeps the identity of the others.
    CHECK(says(refusal({files[0], withText(files[1], "a device", "b device")}),
               "device: \"b device\", not \"a device\""));
    CHECK(says(
        refusal({withText(files[0], "a device", "b device"), withText(files[1], "a device", "b device")}),
        "0: holds something else than its identity says"));
    CHECK(says(refusal({edited(files[0], kLightMaps, [](auto& raw) { raw[0] ^= std::byte(1); }), files[1]}),
               "0: holds something else than its identity says"));
    const Bytes claims = edited(files[1], kShard, [](auto& raw) { raw[20] ^= std::byte(1); });
    CHECK(says(refusal({files[0], claims}), "1: is a shard of another bake than 0: identity"));
}

TEST_CASE("merge: cut at any length and with any bit flipped, a shard is refused") {
    const Asset asset = shardedAsset();
    std::vector<Bytes> files = shardsOf(asset, 3);
    const Bytes good = files[1];
    std::mt19937 random(4);
    for (int i = 0; i < 150; i++) {
        files[1] = good;
        files[1].resize(random() % good.size());
        CHECK(says(refusal(files), "1: "));
        files[1] = good;
        files[1][random() % good.size()] ^= std::byte(1u << random() % 8);
        CHECK(says(refusal(files), "1: "));
    }
}

TEST_CASE("merge: damage under right checksums is refused or harmless") {
    const Asset asset = shardedAsset();
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        const std::vector<Bytes> files = shardsOf(asset, 3, layout);
        std::mt19937 random(6);
        int refused = 0;
        for (int i = 0; i < 200; i++) {
            std::vector<Bytes> damaged = files;
            std::vector<RawChunk> chunks = chunksOf(files[size_t(i % 3)]);
            RawChunk& chunk = chunks[random() % chunks.size()];
            chunk.raw[random() % chunk.raw.size()] ^= std::byte(1u << random() % 8);
            damaged[size_t(i % 3)] = fileOf(chunks);
            try {
                decodeAsset(merged(damaged), "merged");
            } catch (const Error& failure) {
                CHECK_FALSE(says(failure.what(), "merged")); // else the merge passed on what readers refuse
                refused++;
            }
        }
        CHECK_GT(refused, 50);
    }
}

TEST_CASE("merge: a shard must hold its own blocks and no others, and what each lost") {
    const Asset asset = shardedAsset();
    const std::vector<Bytes> files = shardsOf(asset, 2);
    const auto isTransport = [](const RawChunk& chunk) { return chunk.tag == SparseTransport::kTag; };
    std::vector<RawChunk> own = chunksOf(files[0]);
    const std::vector<RawChunk> others = chunksOf(files[1]);

    std::vector<RawChunk> overlapping = own;
    overlapping.push_back(*std::ranges::find_if(others, isTransport));
    CHECK(says(refusal({fileOf(overlapping), files[1]}),
               "0: holds 8 chunks of transport, and shard 0/2 has 7"));
    std::vector<RawChunk> lacking = own;
    lacking.erase(std::ranges::find_if(lacking, isTransport));
    CHECK(says(refusal({fileOf(lacking), files[1]}), "0: chunk TRAN of set 0, run 0, is missing"));
    std::vector<RawChunk> shifted = own;
    std::ranges::find_if(shifted, isTransport)->raw = std::ranges::find_if(others, isTransport)->raw;
    CHECK(says(refusal({fileOf(shifted), files[1]}), "0: chunk TRAN of set 0, run 0"));

    const auto refusalOf = [&](ChunkTag tag, const std::function<void(std::vector<std::byte>&)>& edit) {
        return refusal({edited(files[0], tag, edit), files[1]});
    };
    CHECK(says(refusalOf(kBlockLosses, [](auto& raw) { raw.resize(24); }),
               "0: chunk LOSS: expected 128 bytes"));
    CHECK(says(refusalOf(kBlockLosses, [](auto& raw) { raw.resize(129); }),
               "0: chunk LOSS: expected 128 bytes"));
    for (double wrong : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")})
        CHECK(says(
            refusalOf(kBlockLosses, [&](auto& raw) { poke(raw, 32, std::bit_cast<uint64_t>(wrong), 8); }),
            "0: chunk LOSS: expected finite"));
    CHECK(says(refusalOf(kBlockLosses, [](auto& raw) { poke(raw, 8, std::bit_cast<uint64_t>(1e300), 8); }),
               "the bake"));
    CHECK(says(refusalOf(kShard, [](auto& raw) { poke(raw, 0, 2, 4); }), "0: says to be shard 2 of 2"));
    CHECK(says(refusalOf(kShard, [](auto& raw) { poke(raw, 4, 0, 4); }), "0: says to be shard 0 of 0"));
    CHECK(says(refusalOf(kShard, [](auto& raw) { raw.push_back({}); }), "0: expected one chunk SHRD"));
    own.push_back({kShard, kWholeFile, 1, std::ranges::find(own, kShard, &RawChunk::tag)->raw});
    CHECK(says(refusal({fileOf(own), files[1]}), "0: expected one chunk SHRD"));
    own.pop_back();
    CHECK(says(refusalOf(SparseTransport::kTag,
                         [](auto& raw) {
                             const size_t rows =
                                 ByteReader(std::span(raw).subspan(4), "").get<uint32_t>() * 3;
                             poke(raw, 12 + 5 * rows, 0xffff, 2); // the high plane of the scales
                         }),
               "scales"));
    own.push_back({chunkTag("NEWS"), kWholeFile, 0, {std::byte(1)}});
    CHECK(says(refusal({fileOf(own), files[1]}), "NEWS"));
    own.back().tag = chunkTag("news");
    CHECK(merged({fileOf(own), files[1]}) == wholeBake(asset));
}

// Tests that chunks of a file are checked before they are unpacked, and again when they are loaded.
#include "engine/chunk/chunk_file.h"
#include "tests/support/asset_sample.h"
#include "tests/support/failure.h"

#include <doctest/doctest.h>
#include <zstd.h>

using namespace relume;
using namespace relume::test;

TEST_CASE("chunk file: a chunk is no larger than chunks may be, nor than its bytes can stand for") {
    const auto refusal = [](std::vector<std::byte> raw, uint64_t rawSize) {
        ChunkWriter writer;
        writer.addStored({chunkTag("TEST"), 0, 0, 0, raw.size(), rawSize, hash64(raw)}, [&] { return raw; });
        const std::vector<std::byte> file = writer.finish();
        return failureOf([&] {
            const ChunkFile chunks(file, "file");
            chunks.load(chunks.entries()[0]);
        });
    };
    CHECK(refusal(std::vector<std::byte>(100), 100) == "");
    CHECK(says(refusal(std::vector<std::byte>(100), 50), "cannot stand for"));
    CHECK(says(refusal(std::vector<std::byte>(kLargestChunk + 1), kLargestChunk + 1), "cannot stand for"));
    // Zeros compress to more than a thousandth, which chunks may not.
    std::vector<std::byte> zeros(ZSTD_compressBound(kLargestChunk));
    const std::vector<std::byte> raw(kLargestChunk);
    zeros.resize(ZSTD_compress(zeros.data(), zeros.size(), raw.data(), raw.size(), 1));
    REQUIRE(zeros.size() < 1000);
    CHECK(says(refusal(zeros, kLargestChunk), "cannot stand for"));
    // A frame that is damaged in its middle.
    const std::string text = std::string(5000, 'a') + "bcd";
    StoredChunk stored = storeChunk(chunkTag("TEST"), 0, 0, std::as_bytes(std::span(text)));
    for (size_t i = stored.bytes.size() / 2; i < stored.bytes.size(); i++) stored.bytes[i] = std::byte(0xff);
    CHECK(says(refusal(stored.bytes, 5003), "TEST"));
}

TEST_CASE("chunk file: what changes after it was checked is noticed") {
    const std::vector<std::byte> bytes = encodeAsset(sampleAsset());
    bool isChanged = false;
    ByteSource source{bytes.size(), [&](uint64_t offset, size_t count, std::vector<std::byte>& room) {
                          room.assign(bytes.begin() + ptrdiff_t(offset),
                                      bytes.begin() + ptrdiff_t(offset + count));
                          if (isChanged) room[0] ^= std::byte(1);
                          return std::span<const std::byte>(room);
                      }};
    const ChunkFile file(source, "file");
    isChanged = true;
    CHECK(says(failureOf([&] { file.loadStored(file.entries()[0]); }), "fails its checksum"));
    CHECK(says(failureOf([&] { file.load(file.entries()[0]); }), "file"));
}

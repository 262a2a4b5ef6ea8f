// Fuzz target of the .relume reader. The first byte of an input chooses how deep it strikes:
// 0: the rest is a file; 1: a file whose checksums are put right; 2: edits of the content of a valid file's
// chunks.
#include "engine/transport/asset_info.h"
#include "tests/support/asset_sample.h"

#include <optional>

using namespace relume;
using namespace relume::test;

namespace {

// Each edit is 8 bytes: chunk, kind, offset (2), value (4).
std::vector<std::byte> editedFile(ByteReader in) {
    static const std::vector<RawChunk> sample = chunksOf(encodeAsset(sampleAsset()));
    std::vector<RawChunk> chunks = sample;
    while (in.left() >= 8) {
        RawChunk& chunk = chunks[in.get<uint8_t>() % chunks.size()];
        const auto kind = in.get<uint8_t>();
        const size_t offset = in.get<uint16_t>() % chunk.raw.size();
        const auto value = in.get<uint32_t>();
        switch (kind % 5) {
        case 0:
            poke(chunk.raw, offset, value, 1);
            break;
        case 1:
            poke(chunk.raw, offset, value, 4);
            break;
        case 2:
            chunk.raw.resize(offset + 1);
            break;
        case 3:
            chunk.raw.insert(chunk.raw.end(), value % 4096, std::byte(value >> 24));
            break;
        case 4:
            chunk.run = value;
            break;
        }
    }
    return fileOf(chunks);
}

std::optional<Asset> tryDecode(std::span<const std::byte> file) {
    try {
        return decodeAsset(file, "input");
    } catch (const Error&) {
        return std::nullopt;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0) return 0;
    const auto rest = std::as_bytes(std::span(data, size)).subspan(1);
    std::vector<std::byte> file(rest.begin(), rest.end());
    if (data[0] % 3 == 1) reseal(file);
    if (data[0] % 3 == 2) file = editedFile(ByteReader(rest, "edits"));
    const std::optional<Asset> asset = tryDecode(file);
    if (!asset) return 0;
    // What can be read can be described, written, and read again: an exception here is a finding.
    describeAssetJson(*asset, file.size());
    decodeAsset(encodeAsset(*asset), "again");
    return 0;
}

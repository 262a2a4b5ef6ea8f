// Fuzz target of the .relume reader. The first byte of an input chooses how deep it strikes:
// 0: the rest is a file; 1: a file whose checksums are put right; 2: edits of the content of a valid file's
// chunks. Visibility that a file keeps is read too.
#include "engine/import/asset_info.h"
#include "engine/transport/kept_visibility.h"
#include "tests/support/fuzz_edits.h"
#include "tests/support/kept_sample.h"

#include <optional>

using namespace relume;
using namespace relume::test;

namespace {

std::optional<Asset> tryDecode(std::span<const std::byte> file) {
    try {
        return decodeAsset(file, "input");
    } catch (const Error&) {
        return std::nullopt;
    }
}

void tryVisibility(std::span<const std::byte> file) {
    try {
        KeptVisibility kept(sourceOf(file), "input");
        const Asset skeleton = kept.skeleton();
        kept.verify(skeleton);
        for (uint32_t part = 0; part < skeleton.parts.size(); part++)
            kept.bits(part, 0, uint32_t(skeleton.parts[part].mesh.vertexCount()));
    } catch (const Error&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0) return 0;
    const auto rest = std::as_bytes(std::span(data, size)).subspan(1);
    std::vector<std::byte> file(rest.begin(), rest.end());
    if (data[0] % 3 == 1) reseal(file);
    static const std::vector<RawChunk> sample = keptChunks();
    if (data[0] % 3 == 2) file = editedFile(sample, ByteReader(rest, "edits"));
    tryVisibility(file);
    const std::optional<Asset> asset = tryDecode(file);
    if (!asset) return 0;
    // What can be read can be described, written, and read again: an exception here is a finding.
    describeAssetJson(*asset, file.size());
    decodeAsset(encodeAsset(*asset), "again");
    return 0;
}

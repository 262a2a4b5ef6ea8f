// Readers of .relume files, of this version and of the one before. The first byte of an input chooses how
// deep it strikes: 0: the rest is a file; 1: a file whose checksums are put right; 2: edits of the content of
// a valid file's chunks; 3 and 4: the same as 1 and 2 of a file of the version before; 5: the same as 2 of a
// file with bounced light.
#include "engine/import/asset_info.h"
#include "engine/import/old_asset.h"
#include "engine/transport/kept_visibility.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/fuzz_edits.h"
#include "tests/support/kept_sample.h"
#include "tests/support/old_sample.h"

#include <optional>

namespace relume::test {

namespace {

enum Depth { kRaw, kSealed, kEdits, kOldSealed, kOldEdits, kBouncedEdits, kDepths };

// mixedAsset() without residuals, which files of the version before lack.
Asset oldAsset() {
    Asset asset = mixedAsset(1, kSmallSample);
    asset.parts[1].sets[0].residual = nullptr;
    return asset;
}

EditableFile oldFile() {
    Bytes file = oldFileOf(oldAsset());
    poke(file, 8, kAssetFormatVersion, 4); // for the reader of chunks
    reseal(file);
    return EditableFile(chunksOf(file));
}

// mixedAsset() with shares of direct light.
Asset bouncedAsset() {
    Asset asset = mixedAsset(1, kSmallSample);
    asset.bounces = 2;
    MaterialSet& set = asset.parts[1].sets[0];
    set.directShares.assign(asset.parts[1].mesh.vertexCount() * set.shareWords(), 0x80ff01ffu);
    return asset;
}

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

void run(std::span<const std::byte> input) {
    static const EditableFile sample(keptChunks(kSmallSample)),
        bounced(chunksOf(encodeAsset(bouncedAsset()))), old = oldFile();
    const int depth = input.empty() ? kRaw : int(input[0]) % kDepths;
    const auto rest = input.subspan(std::min<size_t>(input.size(), 1));
    Bytes file(rest.begin(), rest.end());
    if (depth == kEdits) file = editedFile(sample, ByteReader(rest, "edits"));
    if (depth == kBouncedEdits) file = editedFile(bounced, ByteReader(rest, "edits"));
    if (depth == kOldEdits) file = editedFile(old, ByteReader(rest, "edits"));
    if (depth == kOldSealed || depth == kOldEdits) poke(file, 8, kAssetFormatVersion - 1, 4);
    if (depth != kRaw) reseal(file);
    if (isOldAsset(file)) {
        try {
            file = updateAsset(file, "input");
        } catch (const Error&) {
            return;
        }
    }
    tryVisibility(file);
    const std::optional<Asset> asset = tryDecode(file);
    if (!asset) return;
    // What can be read can be described, written, and read again: an exception here is a finding.
    describeAssetJson(*asset, file.size());
    decodeAsset(encodeAsset(*asset), "again");
}

std::vector<Bytes> seeds() {
    const std::string edit = std::string("\x01\x01\x10\0\xff\xff\xff\xff", 8);
    return {seedOf({kRaw}, fileOf(keptChunks(kSmallSample))),
            seedOf({kSealed}, encodeAsset(mixedAsset(1, kSmallSample))),
            seedOf({kEdits}, edit),
            seedOf({kOldSealed}, oldFileOf(oldAsset())),
            seedOf({kOldEdits}, edit),
            seedOf({kSealed}, encodeAsset(bouncedAsset())),
            seedOf({kBouncedEdits}, edit)};
}

const AddFuzzTarget kAdded({"asset", run, seeds});

} // namespace
} // namespace relume::test

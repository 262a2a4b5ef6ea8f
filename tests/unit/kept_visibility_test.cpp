// Tests reading kept visibility block by block, and files that only claim to have it.
#include "engine/base/error.h"
#include "engine/transport/kept_visibility.h"
#include "tests/support/capture_binding.h"
#include "tests/support/kept_sample.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <functional>

using namespace relume;
using namespace relume::test;

namespace {

using Edit = std::function<void(std::vector<RawChunk>& chunks)>;

// The asset's file with visibility in it, edited.
std::filesystem::path writeKept(const TemporaryFolder& folder, const Edit& edit = {}) {
    std::vector<RawChunk> chunks = keptChunks();
    if (edit) edit(chunks);
    writeFileAtomically(folder.path() / "kept.relume", fileOf(chunks));
    return folder.path() / "kept.relume";
}

} // namespace

TEST_CASE("kept visibility: any vertices' bits come back, and other readers pass it by") {
    const TemporaryFolder folder;
    const auto path = writeKept(folder);
    KeptVisibility kept(path);
    CHECK_EQ(kept.key(), kVisibilityKey);
    const Asset asset = keptAsset();
    kept.verify(asset);
    for (uint32_t part = 0; part < 2; part++) {
        const auto vertices = uint32_t(asset.parts[part].mesh.vertexCount());
        const std::vector<uint32_t> bits = bitsOf(part, vertices);
        for (const auto& [first, end] :
             {std::pair(0u, vertices), {3u, 9u}, {5u, 6u}, {vertices - 1, vertices}}) {
            const auto own =
                std::span(bits).subspan(first * kKeptVertexWords, (end - first) * kKeptVertexWords);
            CHECK(std::ranges::equal(kept.bits(part, first, end), own));
        }
    }
    CHECK(kept.storedBytes() > 0);
    const Asset skeleton = kept.skeleton(), whole = readAsset(path);
    CHECK(skeleton.parts[0].mesh.positions == whole.parts[0].mesh.positions);
    CHECK(skeleton.parts[0].sets[0].brdf.lightMaps == whole.parts[0].sets[0].brdf.lightMaps);
    CHECK(rowsOf(skeleton.parts[0].sets[0].transport).values.empty());
    CHECK(encodeAsset(whole) == encodeAsset(asset));
}

TEST_CASE("kept visibility: a file without it has no key") {
    const TemporaryFolder folder;
    writeAsset(folder.path() / "plain.relume", keptAsset());
    const KeptVisibility kept(folder.path() / "plain.relume");
    CHECK(kept.key().empty());
    CHECK_EQ(kept.storedBytes(), 0);
}

TEST_CASE("kept visibility: missing, cut, padded or foreign chunks are refused") {
    const auto lastOf = [](std::vector<RawChunk>& chunks) -> RawChunk& { return chunks.back(); };
    for (const auto& [what, edit] : std::vector<std::pair<std::string, Edit>>{
             {"missing", [](auto& chunks) { chunks.pop_back(); }},
             {"of a part that is not", [&](auto& chunks) { lastOf(chunks).part = 7; }},
             {"short", [&](auto& chunks) { lastOf(chunks).raw.resize(3); }},
             {"long", [&](auto& chunks) { lastOf(chunks).raw.resize(200000); }},
             {"of another run", [&](auto& chunks) { lastOf(chunks).run++; }},
             {"cut", [&](auto& chunks) { lastOf(chunks).raw.pop_back(); }},
             {"padded", [&](auto& chunks) { lastOf(chunks).raw.push_back(std::byte(0)); }}}) {
        CAPTURE_BINDING(what);
        const TemporaryFolder folder;
        const auto path = writeKept(folder, edit);
        CHECK_THROWS_AS(
            {
                KeptVisibility kept(path);
                kept.verify(keptAsset());
                kept.bits(1, 0, 11);
            },
            Error);
    }
    const TemporaryFolder folder;
    const KeptVisibility kept(writeKept(folder));
    Asset other = keptAsset();
    other.parts.pop_back();
    CHECK_THROWS_AS(kept.verify(other), Error);
    other = keptAsset();
    other.parts[0].mesh.positions.pop_back();
    CHECK_THROWS_AS(kept.verify(other), Error);
    other = keptAsset();
    other.visibilitySize = 128;
    CHECK_THROWS_AS(kept.verify(other), Error);
}

TEST_CASE("kept visibility: a key that is none, and every flipped byte, are refused") {
    const TemporaryFolder folder;
    for (const std::string key : {"0123", "0123456789ABCDEF0123456789abcdef"}) {
        const auto path = writeKept(folder, [&](auto& chunks) { setVisibilityKey(chunks, key); });
        CHECK_THROWS_AS(KeptVisibility{path}, Error);
        CHECK_THROWS_AS(readAsset(path), Error);
    }
    const auto path = writeKept(folder);
    const std::vector<std::byte> bytes = readFile(path);
    std::mt19937 random(3);
    for (int i = 0; i < 100; i++) {
        std::vector<std::byte> damaged = bytes;
        damaged[random() % damaged.size()] ^= std::byte(1 << random() % 8);
        if (i % 4 == 0) damaged.resize(random() % bytes.size());
        writeFileAtomically(path, damaged);
        CHECK_THROWS_AS(KeptVisibility{path}, Error);
    }
}

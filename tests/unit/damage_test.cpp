// Tests bakes and checkpoints with any byte changed or cut at any length: they are refused, or harmless, and
// never give another image.
#include "engine/transport/kept_visibility.h"
#include "tests/support/checkpoint_sample.h"
#include "tests/support/failure.h"
#include "tests/support/kept_sample.h"
#include "tests/support/log_capture.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

// What refuses a file; empty: nothing does.
std::string damageFound(std::span<const std::byte> file) {
    return failureOf([&] { decodeAsset(file, "damaged.relume"); });
}

// Calls visit(bytes, place) with every byte inverted, and then with one of its bits flipped, each in its
// turn.
template <typename Visit>
void forEachDamage(Bytes bytes, const Visit& visit) {
    for (size_t place = 0; place < bytes.size(); place++)
        for (const auto damage : {std::byte(0xff), std::byte(1 << place % 8)}) {
            bytes[place] ^= damage;
            visit(std::as_const(bytes), place);
            bytes[place] ^= damage;
        }
}

// Two blocks of a part, and one.
Asset smallAsset() {
    std::mt19937 random(5);
    Asset asset = shardedAsset();
    asset.parts = {samplePart(66, 1, asset.faceSize, 2, random), samplePart(7, 1, asset.faceSize, 2, random)};
    asset.occluder.positions.resize(3);
    asset.occluder.triangles = {{0, 1, 2}};
    return asset;
}

} // namespace

TEST_CASE("damage: a bake with any byte changed is refused by the name of its chunk") {
    constexpr size_t kHeaderBytes = 32, kEntryBytes = 48;
    const Bytes file = fileOf(keptChunks());
    const ChunkFile chunks(file, "whole");
    const auto entryAt = [&](size_t place) {
        return std::ranges::find_if(chunks.entries(), [&](const ChunkEntry& entry) {
            return place >= entry.offset && place - entry.offset < entry.storedSize;
        });
    };
    size_t tried = 0;
    forEachDamage(file, [&](const Bytes& damaged, size_t place) {
        CAPTURE(place);
        const std::string failure = damageFound(damaged);
        REQUIRE(failure.starts_with("damaged.relume: "));
        if (place >= kHeaderBytes + kEntryBytes * chunks.entries().size()) {
            const auto entry = entryAt(place);
            REQUIRE(entry != chunks.entries().end());
            REQUIRE(failure.find("chunk " + tagText(entry->tag)) != std::string::npos);
            REQUIRE(failure.find("fails its checksum") != std::string::npos);
        }
        tried++;
    });
    CHECK(tried == 2 * file.size());
    CHECK(file.size() > 10'000);
}

TEST_CASE("damage: a bake cut at any length is refused") {
    const Bytes file = fileOf(keptChunks());
    for (size_t size = 0; size < file.size(); size++) {
        CAPTURE(size);
        const std::string failure = damageFound(std::span(file).first(size));
        REQUIRE(failure.find(size < 32 ? "not a .relume file" : "cut short") != std::string::npos);
    }
}

TEST_CASE("damage: from a checkpoint with any byte changed, or cut anywhere, the same bake is made or none") {
    const LogCapture log; // which says what is dropped
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        const CheckpointSample sample(layout, smallAsset());
        size_t same = 0, refused = 0, dropped = 0;
        const auto resume = [&](const Bytes& file) {
            size_t found = 0;
            try {
                const Bytes bake = sample.resumed(file, &found);
                REQUIRE(bake == sample.bake());
                same++;
                dropped += found < 3;
            } catch (const Error& error) {
                REQUIRE(std::string(error.what()).find("checkpoint") != std::string::npos);
                refused++;
            }
        };
        const Bytes& file = sample.file();
        forEachDamage(file, [&](const Bytes& damaged, size_t) { resume(damaged); });
        CHECK(refused == 2 * 8); // the magic number, by which it is taken for another file
        CHECK(same == 2 * (file.size() - 8));
        CHECK(dropped == same); // no damage goes unseen
        for (size_t size = 0; size < file.size(); size++)
            resume({file.begin(), file.begin() + ptrdiff_t(size)});
        CHECK(refused == 2 * 8);
        CHECK(same == 2 * (file.size() - 8) + file.size());
    }
}

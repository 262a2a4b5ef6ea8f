// Readers of what programs keep for themselves: checkpoints of bakes, and the pipeline cache. The first byte
// of an input chooses how deep it strikes: 0: the rest is a checkpoint; 1: one whose records' checksums are
// put right; 2 and 3: edits of a valid one, before and after its checksums are put right; 4: the rest is a
// pipeline cache; 5: edits of a valid one; 6: its checksum is put right.
#include "engine/base/check.h"
#include "engine/vk/pipeline_cache.h"
#include "precompute/bake/checkpoint.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/checkpoint_sample.h"
#include "tests/support/fuzz_edits.h"

#include <cstring>

namespace relume::test {

namespace {

enum Depth { kRaw, kSealed, kEdits, kSealedEdits, kCache, kCacheEdits, kCacheSealedEdits, kDepths };

VkPhysicalDeviceProperties sampleDriver() {
    VkPhysicalDeviceProperties driver{};
    driver.vendorID = 0x1234;
    driver.deviceID = 0x5678;
    driver.driverVersion = 9;
    driver.pipelineCacheUUID[3] = 7;
    return driver;
}

Bytes sampleCache() {
    VkPipelineCacheHeaderVersionOne header{
        sizeof header, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, 0x1234, 0x5678, {}};
    header.pipelineCacheUUID[3] = 7;
    Bytes data(sizeof header + 100, std::byte(42));
    std::memcpy(data.data(), &header, sizeof header);
    return vk::packPipelineCache(sampleDriver(), data);
}

void runCache(int depth, std::span<const std::byte> rest) {
    constexpr size_t kHeaderBytes = 56;
    static const Bytes sample = sampleCache();
    Bytes file(rest.begin(), rest.end());
    if (depth != kCache) file = editedBytes(sample, ByteReader(rest, "edits"));
    if (depth == kCacheSealedEdits && file.size() >= kHeaderBytes)
        poke(file, kHeaderBytes - 8, hash64(std::span(file).subspan(kHeaderBytes)), 8);
    const auto data = vk::unpackPipelineCache(sampleDriver(), file);
    if (data.empty() || depth == kCacheSealedEdits) return;
    // What is handed to a driver is what was kept.
    RELUME_CHECK(std::ranges::equal(data, std::span(file).subspan(kHeaderBytes)));
    if (depth == kCacheEdits) RELUME_CHECK(file == sample);
}

// A bake of two parts, of two blocks and of one.
CheckpointSample sampleIn(TransportLayout layout) { return CheckpointSample(layout, shardedAsset(70, 3)); }

void runCheckpoint(int depth, std::span<const std::byte> rest) {
    static const CheckpointSample rows = sampleIn(TransportLayout::Rows),
                                  bases = sampleIn(TransportLayout::Bases);
    const bool isInBases = !rest.empty() && int(rest[0]) % 2 == 1;
    const CheckpointSample& sample = isInBases ? bases : rows;
    rest = rest.subspan(std::min<size_t>(rest.size(), 1));
    Bytes file(rest.begin(), rest.end());
    if (depth == kEdits || depth == kSealedEdits)
        file = editedBytes(sample.file(), ByteReader(rest, "edits"));
    if (depth == kSealed || depth == kSealedEdits) resealCheckpoint(file);
    try {
        const Bytes whole = sample.resumed(file);
        // Blocks that were not forged make the bake that they are of.
        if (depth == kRaw || depth == kEdits) RELUME_CHECK(whole == sample.bake());
    } catch (const Error&) {
    }
}

void run(std::span<const std::byte> input) {
    const int depth = input.empty() ? kRaw : int(input[0]) % kDepths;
    const auto rest = input.subspan(std::min<size_t>(input.size(), 1));
    if (depth >= kCache)
        runCache(depth, rest);
    else
        runCheckpoint(depth, rest);
}

std::vector<Bytes> seeds() {
    const std::string edit = std::string("\x01\x00\x50\0\xff\xff\xff\xff", 8);
    // A version that Vulkan's enumeration does not have.
    const std::string version = std::string("\x01\x00\x3c\0\xff\xff\xff\xff", 8);
    std::vector<Bytes> all = {seedOf({kCache}, sampleCache()), seedOf({kCacheEdits}, edit),
                              seedOf({kCacheSealedEdits}, version)};
    for (const int layout : {0, 1}) {
        const Bytes file = sampleIn(layout == 0 ? TransportLayout::Rows : TransportLayout::Bases).file();
        all.push_back(seedOf({kRaw, layout}, file));
        all.push_back(seedOf({kSealed, layout}, file));
        all.push_back(seedOf({kEdits, layout}, edit));
        all.push_back(seedOf({kSealedEdits, layout}, edit));
    }
    return all;
}

const AddFuzzTarget kAdded({"checkpoint", run, seeds});

} // namespace
} // namespace relume::test

// Fuzz target of the reader of shards. The first byte of an input chooses how deep it strikes, as in
// asset_fuzz.cpp; the second which of two shards it is about.
#include "tests/support/fuzz_edits.h"
#include "tests/support/shard_sample.h"

using namespace relume;
using namespace relume::test;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size < 2) return 0;
    static const std::vector<Bytes> sample = shardsOf(shardedAsset(), 2);
    static const std::vector<std::vector<RawChunk>> chunks = {chunksOf(sample[0]), chunksOf(sample[1])};
    const auto rest = std::as_bytes(std::span(data, size)).subspan(2);
    std::vector<Bytes> files = sample;
    Bytes& file = files[data[1] % 2];
    file.assign(rest.begin(), rest.end());
    if (data[0] % 3 == 1) reseal(file);
    if (data[0] % 3 == 2) file = editedFile(chunks[data[1] % 2], ByteReader(rest, "edits"));
    Bytes whole;
    try {
        whole = merged(files);
    } catch (const Error&) {
        return 0;
    }
    // What was merged can be read: an exception here is a finding.
    decodeAsset(whole, "merged");
    return 0;
}

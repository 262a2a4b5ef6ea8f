// The reader of shards. The first byte of an input chooses how deep it strikes, as in asset_target.cpp; the
// second which of two shards it is about.
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/fuzz_edits.h"
#include "tests/support/shard_sample.h"

#include <array>

namespace relume::test {

namespace {

enum Depth { kRaw, kSealed, kEdits, kDepths };

// Two shards, of two blocks and of one.
std::vector<Bytes> sampleShards() { return shardsOf(shardedAsset(70, 3), 2); }

void run(std::span<const std::byte> input) {
    if (input.size() < 2) return;
    static const std::vector<Bytes> sample = sampleShards();
    static const std::array editable = {EditableFile(chunksOf(sample[0])), EditableFile(chunksOf(sample[1]))};
    const int depth = int(input[0]) % kDepths;
    const size_t which = size_t(input[1]) % 2;
    const auto rest = input.subspan(2);
    std::vector<Bytes> files = sample;
    Bytes& file = files[which];
    file.assign(rest.begin(), rest.end());
    if (depth == kSealed) reseal(file);
    if (depth == kEdits) file = editedFile(editable[which], ByteReader(rest, "edits"));
    Bytes whole;
    try {
        whole = merged(files);
    } catch (const Error&) {
        return;
    }
    // What was merged can be read: an exception here is a finding.
    decodeAsset(whole, "merged");
}

std::vector<Bytes> seeds() {
    const std::vector<Bytes> files = sampleShards();
    const std::string edit = std::string("\x01\x01\x10\0\xff\xff\xff\xff", 8);
    return {seedOf({kRaw, 0}, files[0]), seedOf({kSealed, 1}, files[1]), seedOf({kEdits, 0}, edit)};
}

const AddFuzzTarget kAdded({"shard", run, seeds});

} // namespace
} // namespace relume::test

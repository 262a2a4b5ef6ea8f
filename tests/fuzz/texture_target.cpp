// The reader of textures. The first byte of an input chooses: 0: the rest is a file; 1: a PNG file whose
// check sums are put right.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/texture_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/texture_samples.h"

namespace relume::test {

namespace {

enum Depth { kRaw, kSealed, kDepths };

void run(std::span<const std::byte> input) {
    const int depth = input.empty() ? kRaw : int(input[0]) % kDepths;
    std::string file(textOf(input.subspan(std::min<size_t>(input.size(), 1))));
    if (depth == kSealed) resealPng(file);
    try {
        const Texture texture = decodeTexture(std::as_bytes(std::span(file)), "input", true);
        RELUME_CHECK(texture.width > 0 && texture.height > 0);
        RELUME_CHECK_EQ(texture.texels.size(), texture.texelCount());
    } catch (const Error&) {
    }
}

std::vector<Bytes> seeds() {
    Texture texture{16, 12, {}, true};
    for (uint32_t i = 0; i < texture.texelCount(); i++) texture.texels.push_back(i * 2654435761u);
    return {seedOf({kRaw}, samplePng(texture)), seedOf({kSealed}, samplePng(texture)),
            seedOf({kRaw}, sampleJpeg(texture))};
}

// Compression can make 512 pixels of a byte (checkImageSize), whose decoder holds them several times.
const AddFuzzTarget kAdded({"texture", run, seeds, uint64_t(96) << 20, 512 * 16});

} // namespace
} // namespace relume::test

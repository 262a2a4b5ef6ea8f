// Checks chunks of OpenEXR's lossy compressions, DWAA and DWAB, against the channels that they hold. A chunk
// begins with sizes, and with rules which say how each channel is coded: R, G, B, Y, BY and RY by the cosine
// transform (DCT) of 8 x 8 pixels, A by run lengths, others deflated. The library believes both. Where there
// is less it uses values that nothing wrote, or that lie beyond its buffers. See its ImfDwaCompressor.cpp.
#include "engine/import/exr_check.h"
#include "engine/math/divide_up.h"

#include <OpenEXR/ImfChannelList.h>
#include <array>
#include <cstring>
#include <string_view>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

enum class Coding : uint8_t { Deflated, LossyDct, RunLengths };

struct Rule {
    std::string_view name; // of channels, behind that of their layer
    Coding coding;         // numbers that are no floats are never transformed
    int place;             // among three channels that are transformed together, or -1
};

// The rules by which the library codes. It reads any, but nothing writes others.
constexpr std::array<Rule, 7> kRules = {{{"R", Coding::LossyDct, 0},
                                         {"G", Coding::LossyDct, 1},
                                         {"B", Coding::LossyDct, 2},
                                         {"Y", Coding::LossyDct, -1},
                                         {"BY", Coding::LossyDct, -1},
                                         {"RY", Coding::LossyDct, -1},
                                         {"A", Coding::RunLengths, -1}}};

bool isFor(const Rule& rule, std::string_view channel, Imf::PixelType type) {
    return rule.name == channel.substr(channel.rfind('.') + 1) &&
           (rule.coding == Coding::RunLengths || type != Imf::UINT);
}

// The sizes at the start of a chunk, little-endian as all numbers of OpenEXR: bytes, in the chunk if they are
// packed, and coefficients, of which a block has 1 for direct current (DC) and up to 63 others (AC).
struct Sizes {
    uint64_t version, deflated, deflatedPacked, acPacked, dcPacked, runLengthsPacked, runLengths,
        runLengthPixels, acCount, dcCount, acCompression;
};

// Returns the rules of the channels as they are in each chunk: 2 bytes for the size of it all, then of each
// rule the name and a zero, a byte of its place and coding, and one of its type.
std::string packedRules(const Imf::ChannelList& channels) {
    std::string packed(2, '\0');
    for (const Rule& rule : kRules)
        for (const Imf::PixelType type : {Imf::UINT, Imf::HALF, Imf::FLOAT})
            for (auto i = channels.begin(); i != channels.end(); ++i)
                if (i.channel().type == type && isFor(rule, i.name(), type)) {
                    packed += rule.name;
                    packed += {'\0', char((rule.place + 1) << 4 | int(rule.coding) << 2), char(type)};
                    break;
                }
    packed[0] = char(packed.size());
    return packed;
}

// Counts the blocks that AC coefficients fill, 63 each. A value whose high byte is 255 stands for as many
// zeros as its low byte says, or, if that is 0, for all that remain.
class BlockCounter {
  public:
    void take(uint16_t value) {
        mFilled += value >> 8 != 255 ? 1 : value == 0xff00 ? 63 : value & 255;
        if (mFilled < 63) return;
        mFilled = 0;
        mBlocks++;
    }
    uint64_t blocks() const { return mBlocks; }

  private:
    uint64_t mBlocks = 0;
    int mFilled = 0;
};

// Returns whether there are `count` values, and they fill at least `blocks` blocks: a NaN is written as a
// value, and read as zeros.
bool fillBlocks(Bytes packed, uint64_t compression, uint64_t count, uint64_t blocks) {
    enum { Huffman, Deflate };
    BlockCounter counter;
    const auto takeOne = [&](uint16_t value) { counter.take(value); };
    const auto takeAll = [&](Bytes piece) {
        for (size_t i = 0; i + 1 < piece.size(); i += 2)
            takeOne(uint16_t(std::to_integer<int>(piece[i]) | std::to_integer<int>(piece[i + 1]) << 8));
    };
    return (compression == Huffman ? decodeExrHuffman(packed, count, takeOne)
                                   : compression == Deflate && isDeflatedFrom(packed, 2 * count, takeAll)) &&
           counter.blocks() >= blocks;
}

} // namespace

bool isDwaOf(Bytes packed, const Imf::ChannelList& channels, const Imath::Box2i& box) {
    uint64_t blocks = 0, runLengthBytes = 0, deflatedBytes = 0;
    for (auto i = channels.begin(); i != channels.end(); ++i) {
        const Imf::Channel& channel = i.channel();
        const uint32_t width = countMultiples(channel.xSampling, box.min.x, box.max.x),
                       height = countMultiples(channel.ySampling, box.min.y, box.max.y);
        const uint64_t bytes = uint64_t(width) * height * (channel.type == Imf::HALF ? 2 : 4);
        Coding coding = Coding::Deflated;
        for (const Rule& rule : kRules)
            if (isFor(rule, i.name(), channel.type)) coding = rule.coding;
        if (coding == Coding::LossyDct) blocks += uint64_t(divideUp(width, 8)) * divideUp(height, 8);
        if (coding == Coding::RunLengths) runLengthBytes += bytes;
        if (coding == Coding::Deflated) deflatedBytes += bytes;
    }

    const std::string rules = packedRules(channels);
    Sizes sizes;
    if (packed.size() < sizeof sizes + rules.size()) return false;
    std::memcpy(&sizes, packed.data(), sizeof sizes);
    if (std::memcmp(packed.data() + sizeof sizes, rules.data(), rules.size()) != 0) return false;
    if (sizes.version != 2 || sizes.deflated != deflatedBytes || sizes.dcCount != blocks ||
        sizes.runLengthPixels != runLengthBytes)
        return false;
    Bytes rest = packed.subspan(sizeof sizes + rules.size());
    if (sizes.deflatedPacked > rest.size()) return false;
    if (deflatedBytes == 0 ? sizes.deflatedPacked > 0
                           : !isDeflatedFrom(rest.first(sizes.deflatedPacked), deflatedBytes))
        return false;
    rest = rest.subspan(sizes.deflatedPacked);
    if (sizes.acPacked > rest.size() || sizes.acCount > 63 * blocks) return false;
    if (blocks == 0) return sizes.acPacked == 0 && sizes.dcPacked == 0;
    return fillBlocks(rest.first(sizes.acPacked), sizes.acCompression, sizes.acCount, blocks);
}

} // namespace relume

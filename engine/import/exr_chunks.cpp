// Checks the chunks of an OpenEXR file: blocks of lines, or tiles. The library reads a chunk that unpacks to
// fewer bytes than its pixels have as a full one, and leaves the rest of its buffer as it was.
#include "engine/base/error.h"
#include "engine/import/exr_check.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTileDescription.h>
#include <algorithm>
#include <cstring>
#include <fmt/core.h>
#include <vector>
#include <zlib.h>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

int64_t divideDown(int64_t a, int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Returns the number of multiples of `step` from `first` to `last`.
int64_t multiples(int64_t step, int64_t first, int64_t last) {
    return divideDown(last, step) - divideDown(first - 1, step);
}

// Returns the bytes of an area's pixels in all channels.
size_t unpackedBytes(const Imf::ChannelList& channels, const Imath::Box2i& area) {
    size_t bytes = 0;
    for (auto i = channels.begin(); i != channels.end(); ++i) {
        const Imf::Channel& channel = i.channel();
        const int64_t samples = multiples(channel.xSampling, area.min.x, area.max.x) *
                                multiples(channel.ySampling, area.min.y, area.max.y);
        bytes += size_t(samples) * (channel.type == Imf::HALF ? 2 : 4);
    }
    return bytes;
}

// Returns whether run lengths unpack to `wanted` bytes: after n >= 0 comes a byte that repeats n + 1 times,
// after n < 0 there are -n bytes.
bool isRunLengthsOf(Bytes packed, size_t wanted) {
    size_t unpacked = 0;
    while (!packed.empty()) {
        const int n = std::to_integer<signed char>(packed[0]);
        const size_t taken = 1 + (n < 0 ? size_t(-n) : 1);
        if (taken > packed.size()) return false;
        unpacked += n < 0 ? size_t(-n) : size_t(n) + 1;
        packed = packed.subspan(taken);
    }
    return unpacked == wanted;
}

bool isDeflatedFrom(Bytes packed, size_t wanted) {
    std::vector<Bytef> unpacked(wanted);
    uLongf size = uLongf(wanted);
    return uncompress(unpacked.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                      uLong(packed.size())) == Z_OK &&
           size == wanted;
}

// Returns the number of lines of a chunk that is no tile.
int64_t linesOf(Imf::Compression compression) {
    switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
        return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
        return 16;
    case Imf::DWAB_COMPRESSION:
        return 256;
    default:
        return 32;
    }
}

class ChunkWalk {
  public:
    ChunkWalk(Bytes file, size_t tableStart, const Imf::Header& header, bool isTiled, const std::string& name)
        : mFile(file), mTableStart(tableStart), mHeader(header), mIsTiled(isTiled), mName(name) {}

    void run() {
        const Imath::Box2i& window = mHeader.dataWindow();
        const int64_t width =
            mIsTiled ? mHeader.tileDescription().xSize : int64_t(window.max.x) - window.min.x + 1;
        const int64_t height = mIsTiled ? mHeader.tileDescription().ySize : linesOf(mHeader.compression());
        size_t chunk = 0;
        for (int64_t y = window.min.y; y <= window.max.y; y += height)
            for (int64_t x = window.min.x; x <= window.max.x; x += width)
                check(chunk++, {{int(x), int(y)},
                                {int(std::min<int64_t>(x + width - 1, window.max.x)),
                                 int(std::min<int64_t>(y + height - 1, window.max.y))}});
    }

  private:
    template <class Number>
    Number numberAt(uint64_t place) const {
        if (place > mFile.size() || sizeof(Number) > mFile.size() - place) fail("it lacks pixels");
        Number number;
        std::memcpy(&number, mFile.data() + place, sizeof number);
        return number;
    }

    [[noreturn]] void fail(std::string_view why) const {
        throw Error(fmt::format("{}: damaged OpenEXR file: {}; get the file again", mName, why));
    }

    void check(size_t chunk, const Imath::Box2i& area) const {
        const size_t coordinates = mIsTiled ? 16 : 4;
        const auto start = numberAt<uint64_t>(mTableStart + 8 * chunk);
        if (start < mTableStart || start >= mFile.size()) fail("it lacks pixels");
        const auto size = numberAt<int32_t>(start + coordinates);
        const uint64_t first = start + coordinates + sizeof size;
        if (size < 0 || first > mFile.size() || uint64_t(size) > mFile.size() - first)
            fail("it lacks pixels");
        const size_t wanted = unpackedBytes(mHeader.channels(), area);
        if (size_t(size) < wanted && !unpacksTo(mFile.subspan(first, size_t(size)), wanted))
            fail("pixels do not unpack to what they should");
    }

    bool unpacksTo(Bytes packed, size_t wanted) const {
        switch (mHeader.compression()) {
        case Imf::NO_COMPRESSION:
            return false;
        case Imf::RLE_COMPRESSION:
            return isRunLengthsOf(packed, wanted);
        case Imf::ZIPS_COMPRESSION:
        case Imf::ZIP_COMPRESSION:
            return isDeflatedFrom(packed, wanted);
        default: // of which the library refuses all that are too short, except none
            return !packed.empty();
        }
    }

    Bytes mFile;
    size_t mTableStart;
    const Imf::Header& mHeader;
    bool mIsTiled;
    const std::string& mName;
};

} // namespace

void checkExrChunks(Bytes bytes, size_t headerBytes, const Imf::Header& header, bool isTiled,
                    const std::string& name) {
    ChunkWalk(bytes, headerBytes, header, isTiled, name).run();
}

} // namespace relume

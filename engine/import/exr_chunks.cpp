// Checks the chunks of an OpenEXR file: blocks of lines, or tiles. The library reads a chunk that unpacks to
// fewer bytes than its pixels have as a full one, and leaves the rest of its buffer as it was.
#include "engine/base/error.h"
#include "engine/import/exr_check.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTileDescription.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/core.h>
#include <map>
#include <new>
#include <optional>
#include <zlib.h>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

int64_t divideDown(int64_t a, int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Returns the number of multiples of `step` from `first` to `last`.
int64_t multiples(int64_t step, int64_t first, int64_t last) {
    return divideDown(last, step) - divideDown(first - 1, step);
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

// Returns whether a zlib stream inflates to `wanted` bytes, which are counted and not kept.
bool isDeflatedFrom(Bytes packed, size_t wanted) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data())); // zlib only reads them
    stream.avail_in = uInt(packed.size());
    std::array<Bytef, 16384> unpacked;
    int state = Z_OK;
    while (state == Z_OK && stream.total_out <= wanted) {
        stream.next_out = unpacked.data();
        stream.avail_out = uInt(unpacked.size());
        state = inflate(&stream, Z_NO_FLUSH);
    }
    const bool isWanted = state == Z_STREAM_END && stream.total_out == wanted;
    inflateEnd(&stream);
    return isWanted;
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
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
        return 32;
    default:
        return 256;
    }
}

class ChunkWalk {
  public:
    ChunkWalk(Bytes file, size_t tableStart, const Imf::Header& header, const std::string& name)
        : mFile(file), mTableStart(tableStart), mHeader(header), mName(name) {
        const Imath::Box2i& window = header.dataWindow();
        for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
            const Imf::Channel& channel = i.channel();
            mLineBytes[channel.ySampling] +=
                size_t(multiples(channel.xSampling, window.min.x, window.max.x)) *
                (channel.type == Imf::HALF ? 2 : 4);
        }
    }

    // The library seeks the first block of lines and reads on from there, whatever the table says.
    void checkLines() const {
        const Imath::Box2i& window = mHeader.dataWindow();
        const int64_t lines = linesOf(mHeader.compression());
        const bool isIncreasing = mHeader.lineOrder() == Imf::INCREASING_Y;
        std::optional<Chunk> previous;
        size_t number = 0;
        for (int64_t y = window.min.y; y <= window.max.y; y += lines) {
            const Chunk chunk = chunkAt(number++, std::array{int32_t(y)});
            if (previous && (isIncreasing ? previous->end != chunk.start : chunk.end != previous->start))
                fail("its lines do not follow one another");
            size_t wanted = 0;
            const int64_t last = std::min<int64_t>(y + lines - 1, window.max.y);
            for (const auto& [sampling, bytes] : mLineBytes)
                wanted += size_t(multiples(sampling, y, last)) * bytes;
            check(chunk, wanted);
            previous = chunk;
        }
    }

    // Checks the tiles of the full resolution, which come first in the table.
    void checkTiles() const {
        const Imath::Box2i& window = mHeader.dataWindow();
        const int64_t width = int64_t(window.max.x) - window.min.x + 1,
                      height = int64_t(window.max.y) - window.min.y + 1;
        const int64_t tileWidth = mHeader.tileDescription().xSize,
                      tileHeight = mHeader.tileDescription().ySize;
        const size_t pixelBytes = mLineBytes.at(1) / size_t(width); // tiles have no subsampling
        size_t number = 0;
        for (int64_t y = 0; y * tileHeight < height; y++)
            for (int64_t x = 0; x * tileWidth < width; x++) {
                const int64_t area = std::min(tileWidth, width - x * tileWidth) *
                                     std::min(tileHeight, height - y * tileHeight);
                check(chunkAt(number++, std::array{int32_t(x), int32_t(y), 0, 0}), size_t(area) * pixelBytes);
            }
    }

  private:
    struct Chunk {
        uint64_t start, end;
        Bytes packed;
    };

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

    // Returns a chunk by its number in the table, which must begin with its coordinates.
    template <class Coordinates>
    Chunk chunkAt(size_t number, const Coordinates& coordinates) const {
        const auto start = numberAt<uint64_t>(mTableStart + 8 * number);
        if (start < mTableStart || start >= mFile.size()) fail("it lacks pixels");
        if (numberAt<Coordinates>(start) != coordinates) fail("pixels are of another place");
        const auto size = numberAt<int32_t>(start + sizeof coordinates);
        const uint64_t first = start + sizeof coordinates + sizeof size;
        if (size < 0 || uint64_t(size) > mFile.size() - first) fail("it lacks pixels");
        return {start, first + uint64_t(size), mFile.subspan(first, size_t(size))};
    }

    void check(const Chunk& chunk, size_t wanted) const {
        if (chunk.packed.size() < wanted && !unpacksTo(chunk.packed, wanted))
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
        default: // the library itself refuses what is short, but for nothing at all, and some of DWAA and
                 // DWAB
            return !packed.empty();
        }
    }

    Bytes mFile;
    size_t mTableStart;
    const Imf::Header& mHeader;
    const std::string& mName;
    std::map<int, size_t> mLineBytes; // of a line, by the ySampling of channels
};

} // namespace

void checkExrChunks(Bytes bytes, size_t headerBytes, const Imf::Header& header, bool isTiled,
                    const std::string& name) {
    const ChunkWalk walk(bytes, headerBytes, header, name);
    if (isTiled)
        walk.checkTiles();
    else
        walk.checkLines();
}

} // namespace relume

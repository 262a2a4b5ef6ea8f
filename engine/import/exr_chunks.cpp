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
#include <new>
#include <optional>
#include <vector>
#include <zlib.h>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

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

// Returns false for what the library does not refuse itself: a chunk in PIZ without bytes, or whose few
// values have so many codes that it would take long. A chunk has the first and the last byte of a bit map,
// the map from the one to the other, the number of bytes that follow, and values in Huffman coding.
bool isPizOf(Bytes packed, size_t wanted) {
    std::array<uint16_t, 2> map;
    if (packed.size() < sizeof map) return false;
    std::memcpy(map.data(), packed.data(), sizeof map);
    const size_t start = sizeof map + (map[0] <= map[1] ? size_t(map[1] - map[0]) + 1 : 0) + sizeof(int32_t);
    if (packed.size() < start) return false;
    const Bytes values = packed.subspan(start);
    uint32_t bits = 0;
    if (values.size() >= 16) std::memcpy(&bits, &values[12], sizeof bits);
    constexpr uint32_t kFast = 128; // more bits go to another decoder, of which many codes cost little
    return bits > kFast || decodeExrHuffman(values, wanted / 2, [](uint16_t) {});
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
        : mFile(file), mTableStart(tableStart), mHeader(header), mWindow(header.dataWindow()), mName(name) {}

    // The library seeks the first block of lines and reads on from there, whatever the table says.
    void checkLines() const {
        const int64_t lines = linesOf(mHeader.compression());
        const bool isIncreasing = mHeader.lineOrder() == Imf::INCREASING_Y;
        std::optional<Chunk> previous;
        size_t number = 0;
        for (int64_t y = mWindow.min.y; y <= mWindow.max.y; y += lines) {
            const Chunk chunk = chunkAt(number++, std::array{int32_t(y)});
            if (previous && (isIncreasing ? previous->end != chunk.start : chunk.end != previous->start))
                fail("its lines do not follow one another");
            check(chunk, boxAt(mWindow.min.x, y, int64_t(mWindow.max.x) - mWindow.min.x + 1, lines));
            previous = chunk;
        }
    }

    // Checks the tiles of the full resolution, which come first in the table.
    void checkTiles() const {
        const int64_t width = mHeader.tileDescription().xSize, height = mHeader.tileDescription().ySize;
        std::vector<std::pair<uint64_t, uint64_t>> places;
        for (int64_t y = mWindow.min.y, row = 0; y <= mWindow.max.y; y += height, row++)
            for (int64_t x = mWindow.min.x, column = 0; x <= mWindow.max.x; x += width, column++) {
                const Chunk chunk = chunkAt(places.size(), std::array{int32_t(column), int32_t(row), 0, 0});
                check(chunk, boxAt(x, y, width, height));
                places.emplace_back(chunk.start, chunk.end);
            }
        std::ranges::sort(places);
        for (size_t i = 1; i < places.size(); i++)
            if (places[i].first < places[i - 1].second) fail("its tiles overlap");
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

    // Returns the box of a chunk's pixels: the last ones may have fewer than others.
    Imath::Box2i boxAt(int64_t x, int64_t y, int64_t width, int64_t height) const {
        return {{int(x), int(y)},
                {int(std::min<int64_t>(x + width - 1, mWindow.max.x)),
                 int(std::min<int64_t>(y + height - 1, mWindow.max.y))}};
    }

    size_t bytesOf(const Imath::Box2i& box) const {
        size_t bytes = 0;
        for (auto i = mHeader.channels().begin(); i != mHeader.channels().end(); ++i) {
            const Imf::Channel& channel = i.channel();
            bytes += size_t(countMultiples(channel.xSampling, box.min.x, box.max.x)) *
                     countMultiples(channel.ySampling, box.min.y, box.max.y) *
                     (channel.type == Imf::HALF ? 2 : 4);
        }
        return bytes;
    }

    void check(const Chunk& chunk, const Imath::Box2i& box) const {
        const size_t wanted = bytesOf(box);
        if (chunk.packed.size() < wanted && !unpacksTo(chunk.packed, wanted, box))
            fail("pixels do not unpack to what they should");
    }

    bool unpacksTo(Bytes packed, size_t wanted, const Imath::Box2i& box) const {
        switch (mHeader.compression()) {
        case Imf::NO_COMPRESSION:
            return false;
        case Imf::RLE_COMPRESSION:
            return isRunLengthsOf(packed, wanted);
        case Imf::ZIPS_COMPRESSION:
        case Imf::ZIP_COMPRESSION:
            return isDeflatedFrom(packed, wanted);
        case Imf::PIZ_COMPRESSION:
            return isPizOf(packed, wanted);
        case Imf::DWAA_COMPRESSION:
        case Imf::DWAB_COMPRESSION:
            return isDwaOf(packed, mHeader.channels(), box);
        default: // the library itself refuses what is short, but for nothing at all
            return !packed.empty();
        }
    }

    Bytes mFile;
    size_t mTableStart;
    const Imf::Header& mHeader;
    const Imath::Box2i mWindow;
    const std::string& mName;
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

bool isDeflatedFrom(Bytes packed, uint64_t wanted, const std::function<void(Bytes)>& take) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data())); // zlib only reads them
    stream.avail_in = uInt(packed.size());
    std::array<std::byte, 16384> unpacked;
    int state = Z_OK;
    while (state == Z_OK && stream.total_out <= wanted) {
        stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
        stream.avail_out = uInt(unpacked.size());
        state = inflate(&stream, Z_NO_FLUSH);
        if (take) take(Bytes(unpacked).first(unpacked.size() - stream.avail_out));
    }
    const bool isWanted = state == Z_STREAM_END && stream.total_out == wanted;
    inflateEnd(&stream);
    return isWanted;
}

uint32_t countMultiples(int step, int first, int last) {
    const auto divideDown = [](int64_t a, int64_t b) { return a / b - (a % b < 0 ? 1 : 0); };
    return uint32_t(divideDown(last, step) - divideDown(int64_t(first) - 1, step));
}

} // namespace relume

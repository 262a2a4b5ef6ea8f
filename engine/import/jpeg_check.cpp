#include "engine/import/jpeg_check.h"

#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/core.h>
#include <map>
#include <string_view>

namespace relume {
namespace {

using Bytes = std::span<const std::byte>;

// Takes big-endian numbers from the front of a file or segment.
class Reader {
  public:
    Reader(Bytes bytes, const std::string& name) : mBytes(bytes), mName(name) {}

    bool isEmpty() const { return mBytes.empty(); }

    Bytes take(size_t count) {
        if (count > mBytes.size())
            throw Error(fmt::format("{}: is truncated or corrupt: get the file again", mName));
        const Bytes taken = mBytes.first(count);
        mBytes = mBytes.subspan(count);
        return taken;
    }

    uint32_t takeNumber(size_t width) {
        uint32_t value = 0;
        for (const std::byte byte : take(width)) value = value << 8 | std::to_integer<uint32_t>(byte);
        return value;
    }

    Reader takeReader(size_t count) { return {take(count), mName}; }

    [[noreturn]] void fail(std::string_view what) const {
        throw Error(fmt::format("{}: is corrupt: {}; get the file again, or save it anew", mName, what));
    }

  private:
    Bytes mBytes;
    const std::string& mName;
};

// Walks a JPEG file's segments (ITU-T T.81, annex B) to the end of the image.
class JpegWalk {
  public:
    JpegWalk(Bytes bytes, const std::string& name) : mFile(bytes, name) {}

    void run() {
        mFile.take(2); // start-of-image marker
        uint32_t marker = mFile.takeNumber(2);
        while (marker != kEnd) {
            while (marker == 0xffff) marker = 0xff00 | mFile.takeNumber(1); // padding
            if (marker < kFirstMarker) mFile.fail("there is something else where a segment starts");
            const uint32_t size = mFile.takeNumber(2);
            if (size < 2) mFile.fail("a segment is too small");
            readSegment(marker, mFile.takeReader(size - 2));
            marker = marker == kScan ? skipScan() : mFile.takeNumber(2);
        }
        if (!mHasScan) mFile.fail("there is no image in it");
    }

  private:
    static constexpr uint32_t kFirstMarker = 0xff02, kHuffman = 0xffc4, kQuantization = 0xffdb;
    static constexpr uint32_t kScan = 0xffda, kEnd = 0xffd9;
    static constexpr uint32_t kBaseline = 0xffc0, kExtended = 0xffc1, kProgressive = 0xffc2;

    void readSegment(uint32_t marker, Reader segment) {
        if (marker == kHuffman) readHuffmanTables(segment);
        if (marker == kQuantization) readQuantizationTables(segment);
        if (marker == kBaseline || marker == kExtended || marker == kProgressive) {
            mIsProgressive = marker == kProgressive;
            readFrame(segment);
        }
        if (marker == kScan) readScan(segment);
    }

    void readHuffmanTables(Reader& segment) {
        while (!segment.isEmpty()) {
            const uint32_t table = segment.takeNumber(1); // class and index, 4 bits each
            uint32_t symbols = 0, codes = 0;
            for (int length = 1; length <= 16; length++) {
                const uint32_t count = segment.takeNumber(1);
                symbols += count;
                codes = 2 * codes + count;
                if (codes > 1u << length) segment.fail("a Huffman table has more codes than there can be");
            }
            if (symbols > 256) segment.fail("a Huffman table has more than 256 symbols");
            segment.take(symbols);
            mHuffman[table] = true;
        }
    }

    void readQuantizationTables(Reader& segment) {
        while (!segment.isEmpty()) {
            const uint32_t table = segment.takeNumber(1); // precision and index, 4 bits each
            segment.take(table >> 4 ? 128 : 64);
            mQuantization[table & 15] = true;
        }
    }

    void readFrame(Reader& segment) {
        if (!mComponents.empty()) segment.fail("it has more than one frame");
        segment.take(5); // precision, height and width
        const uint32_t count = segment.takeNumber(1);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t id = segment.takeNumber(1);
            segment.take(1);
            mComponents[id] = segment.takeNumber(1);
        }
    }

    void readScan(Reader& segment) {
        const uint32_t count = segment.takeNumber(1);
        std::array<std::pair<uint32_t, uint32_t>, 4> tables;
        if (count > tables.size()) segment.fail("a scan has more than four components");
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t id = segment.takeNumber(1), numbers = segment.takeNumber(1);
            if (!mComponents.contains(id) || !mQuantization[mComponents.at(id) & 15])
                segment.fail("a scan is of a component that is not described");
            tables[i] = {numbers >> 4, 0x10 | (numbers & 15)};
        }
        // A progressive scan holds either DC or AC coefficients, and refines DC without a table.
        const uint32_t first = segment.takeNumber(1);
        segment.take(1);
        const bool isRefinement = segment.takeNumber(1) >> 4 != 0;
        const bool needsDc = !mIsProgressive || (first == 0 && !isRefinement);
        const bool needsAc = !mIsProgressive || first > 0;
        for (uint32_t i = 0; i < count; i++)
            if ((needsDc && !mHuffman[tables[i].first]) || (needsAc && !mHuffman[tables[i].second]))
                segment.fail("a scan uses a Huffman table that is missing");
        mHasScan = true;
    }

    // Skips entropy-coded data and returns the marker after it.
    uint32_t skipScan() {
        while (true) {
            if (mFile.takeNumber(1) != 0xff) continue;
            uint32_t code = mFile.takeNumber(1);
            while (code == 0xff) code = mFile.takeNumber(1);
            const bool isRestart = code >= 0xd0 && code <= 0xd7;
            if (code != 0 && !isRestart) return 0xff00 | code;
        }
    }

    Reader mFile;
    std::map<uint32_t, uint32_t> mComponents; // quantization table by component id
    std::array<bool, 256> mHuffman{};
    std::array<bool, 16> mQuantization{};
    bool mIsProgressive = false, mHasScan = false;
};

} // namespace

bool isJpeg(Bytes bytes) {
    return bytes.size() >= 3 && bytes[0] == std::byte(0xff) && bytes[1] == std::byte(0xd8) &&
           bytes[2] == std::byte(0xff);
}

void checkJpeg(Bytes bytes, const std::string& name) { JpegWalk(bytes, name).run(); }

} // namespace relume

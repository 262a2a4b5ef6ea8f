// Reads Radiance .hdr images (Ward: Real Pixels, Graphics Gems II, 1991; the Radiance file formats manual).
// stb_image is not used because its packaged release loops forever on truncated files.
#include "engine/base/error.h"
#include "engine/import/image_codecs.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <string_view>

namespace relume {

namespace {

using Rgbe = std::array<uint8_t, 4>;

class RadianceReader {
  public:
    RadianceReader(std::span<const std::byte> bytes, const std::string& name) : mBytes(bytes), mName(name) {}

    Image read() {
        readHeader();
        Image image = readResolution();
        std::vector<Rgbe> row(size_t(image.width));
        for (int y = 0; y < image.height; y++) {
            readRow(row);
            for (int x = 0; x < image.width; x++) image.at(x, y) = decode(row[size_t(x)]);
        }
        return image;
    }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        throw Error(fmt::format("{}: damaged Radiance file: {} at byte {}; get the file again", mName, what,
                                mPosition));
    }

    uint8_t byte() {
        if (mPosition == mBytes.size()) fail("it ends too early");
        return uint8_t(mBytes[mPosition++]);
    }

    std::string_view line() {
        const size_t start = mPosition;
        while (byte() != '\n') {
        }
        return {reinterpret_cast<const char*>(mBytes.data()) + start, mPosition - 1 - start};
    }

    // Reads header lines up to an empty one. Pixels are RGBE unless a line says otherwise.
    void readHeader() {
        line();
        for (std::string_view text = line(); !text.empty() && text != "\r"; text = line())
            if (text.starts_with("FORMAT=") && !text.starts_with("FORMAT=32-bit_rle_rgbe"))
                throw Error(
                    fmt::format("{}: expected pixels in 32-bit_rle_rgbe, found {}", mName, text.substr(7)));
    }

    Image readResolution() {
        const std::string_view text = line();
        std::string_view rest = text;
        int64_t height = 0, width = 0;
        const auto take = [&](std::string_view prefix, int64_t& number) {
            if (!rest.starts_with(prefix)) return false;
            rest.remove_prefix(prefix.size());
            const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
            rest.remove_prefix(size_t(end - rest.data()));
            return failure == std::errc();
        };
        if (!take("-Y ", height) || !take(" +X ", width))
            throw Error(fmt::format(
                "{}: expected rows from the top (-Y height +X width), found \"{}\"; save it upright", mName,
                text.substr(0, 60)));
        // A run takes 2 bytes for at most 127 values of one component, so a byte holds at most 16 pixels.
        // Accept an eighth of what checkImageSize allows (512 pixels a byte): that leaves room for older
        // runs, yet no kilobytes claim gigabytes.
        checkImageSize(mName, width, height, mBytes.size() / 8);
        checkDensity(mName, width, height, mBytes.size());
        return Image(int(width), int(height));
    }

    void readRow(std::vector<Rgbe>& row) {
        const Rgbe first = {byte(), byte(), byte(), byte()};
        const bool planes = first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!planes) return readPixels(row, first);
        if (size_t(first[2] * 256 + first[3]) != row.size()) fail("a row of another width");
        for (size_t component = 0; component < 4; component++) readPlane(row, component);
    }

    // Reads run lengths of one component: codes above 128 are runs, others count single values.
    void readPlane(std::vector<Rgbe>& row, size_t component) {
        for (size_t x = 0; x < row.size();) {
            const uint8_t code = byte();
            const bool run = code > 128;
            const size_t count = run ? size_t(code) - 128 : code;
            if (count == 0 || count > row.size() - x) fail("a run of impossible length");
            const uint8_t value = run ? byte() : 0;
            for (size_t i = 0; i < count; i++) row[x++][component] = run ? value : byte();
        }
    }

    // Reads whole pixels. (1, 1, 1, n) repeats the previous one n times; consecutive such pixels hold further
    // bytes of the count, lowest first.
    void readPixels(std::vector<Rgbe>& row, Rgbe pixel) {
        unsigned shift = 0;
        for (size_t x = 0;;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                if (x == 0 || shift > 16) fail("a run of impossible length");
                const size_t count = size_t(pixel[3]) << shift;
                if (count > row.size() - x) fail("a run of impossible length");
                for (size_t i = 0; i < count; i++, x++) row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = pixel;
                shift = 0;
            }
            if (x == row.size()) return;
            pixel = {byte(), byte(), byte(), byte()};
        }
    }

    static vec4 decode(Rgbe pixel) {
        if (pixel[3] == 0) return vec4(0, 0, 0, 1);
        const float scale = std::ldexp(1.0f, int(pixel[3]) - 136);
        return vec4(scale * vec3(pixel[0], pixel[1], pixel[2]), 1);
    }

    std::span<const std::byte> mBytes;
    const std::string& mName;
    size_t mPosition = 0;
};

} // namespace

bool isRadiance(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte('#') && bytes[1] == std::byte('?');
}

Image decodeRadiance(std::span<const std::byte> bytes, const std::string& name) {
    return RadianceReader(bytes, name).read();
}

} // namespace relume

#include "engine/base/error.h"
#include "engine/import/image_codecs.h"

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fmt/core.h>
#include <new>
#include <png.h>

namespace relume {

namespace {

// Rendered images compress best, and fastest, as differences from the pixel to the left; levels above 4 take
// several times as long for a tenth less.
constexpr int kFilter = PNG_FILTER_SUB, kLevel = 4;

constexpr png_uint_32 kMostSide = 0x7fffffff; // of the format; libpng's own limit is a million

// Keeps what libpng says of a failure, until an error can be thrown. It makes its own structures without a
// word.
struct Failure {
    char why[128] = "out of memory";
};

// Throws std::bad_alloc if memory ran out, which libpng tells in several ways, otherwise Error with the text.
[[noreturn]] void failPng(const Failure& failure, const std::string& text) {
    if (std::strstr(failure.why, "memory")) throw std::bad_alloc();
    throw Error(text);
}

// Writes all of a PNG file. Returns false if libpng fails: it leaves by longjmp(), past any destructor.
bool encode(png_structp writer, png_infop info, int width, int height, const uint8_t* texels) {
    if (setjmp(png_jmpbuf(writer))) return false;
    png_set_IHDR(writer, info, png_uint_32(width), png_uint_32(height), 8, PNG_COLOR_TYPE_RGB_ALPHA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(writer, PNG_FILTER_TYPE_BASE, kFilter);
    png_set_compression_level(writer, kLevel);
    png_write_info(writer, info);
    for (int y = 0; y < height; y++) png_write_row(writer, texels + 4 * size_t(y) * size_t(width));
    png_write_end(writer, nullptr);
    return true;
}

void append(png_structp writer, png_bytep data, size_t size) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    auto& target = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(writer));
    bool isAppended = true;
    try {
        target.insert(target.end(), first, first + size);
    } catch (const std::bad_alloc&) { // must not pass through libpng
        isAppended = false;
    }
    if (!isAppended) png_error(writer, "out of memory");
}

[[noreturn]] void leave(png_structp png, png_const_charp why) {
    Failure& failure = *static_cast<Failure*>(png_get_error_ptr(png));
    std::snprintf(failure.why, sizeof failure.why, "%s", why);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void take(png_structp reader, png_bytep target, size_t size) {
    auto& rest = *static_cast<std::span<const std::byte>*>(png_get_io_ptr(reader));
    if (size > rest.size()) png_error(reader, "the file ends too early");
    std::memcpy(target, rest.data(), size);
    rest = rest.subspan(size);
}

// Reads all before the pixels, of which only what they need is unpacked. Returns false if libpng fails.
bool readHeader(png_structp reader, png_infop info) {
    if (setjmp(png_jmpbuf(reader))) return false;
    png_set_crc_action(reader, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_keep_unknown_chunks(reader, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_option(reader, PNG_MAXIMUM_INFLATE_WINDOW, PNG_OPTION_ON); // some files claim too small a one
    png_read_info(reader, info);
    return true;
}

// Reads the pixels, four bytes of each, and what follows them. Returns false if libpng fails.
bool readRows(png_structp reader, png_infop info, uint8_t missingAlpha, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reader))) return false;
    png_set_expand(reader);
    png_set_strip_16(reader);
    png_set_gray_to_rgb(reader);
    png_set_add_alpha(reader, missingAlpha, PNG_FILLER_AFTER);
    png_set_interlace_handling(reader);
    png_read_update_info(reader, info); // allocates rows
    png_read_image(reader, rows);
    png_read_end(reader, nullptr);
    return true;
}

// Destroys what libpng allocates to read.
struct ReadStructs {
    png_structp png = nullptr;
    png_infop info = nullptr;

    ReadStructs() = default;
    ReadStructs(const ReadStructs&) = delete;
    ReadStructs& operator=(const ReadStructs&) = delete;
    ~ReadStructs() { png_destroy_read_struct(&png, &info, nullptr); }
};

} // namespace

bool isPng(std::span<const std::byte> bytes) {
    constexpr size_t kSignatureBytes = 8;
    return bytes.size() >= kSignatureBytes &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, kSignatureBytes) == 0;
}

Texture decodePng(std::span<const std::byte> bytes, const std::string& name, uint8_t missingAlpha) {
    Failure failure;
    const auto require = [&](bool isRead) {
        if (!isRead)
            failPng(failure,
                    fmt::format("{}: is truncated or corrupt: {}; get the file again, or save it anew", name,
                                failure.why));
    };
    std::span<const std::byte> rest = bytes;
    ReadStructs reader;
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, leave, ignore);
    if (reader.png) reader.info = png_create_info_struct(reader.png);
    require(reader.info);
    png_set_user_limits(reader.png, kMostSide, kMostSide);
    png_set_read_fn(reader.png, &rest, take);
    require(readHeader(reader.png, reader.info));
    const size_t width = png_get_image_width(reader.png, reader.info),
                 height = png_get_image_height(reader.png, reader.info);
    checkTextureSize(name, int64_t(width), int64_t(height), bytes.size());
    static_assert(std::endian::native == std::endian::little); // red is first in memory
    Texture texture{int(width), int(height), std::vector<uint32_t>(width * height)};
    std::vector<png_bytep> rows;
    for (size_t y = 0; y < height; y++)
        rows.push_back(reinterpret_cast<png_bytep>(&texture.texels[y * width]));
    require(readRows(reader.png, reader.info, missingAlpha, rows.data()));
    return texture;
}

std::vector<std::byte> encodePng(int width, int height, std::span<const uint8_t> texels,
                                 const std::string& name) {
    Failure failure;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, leave, ignore);
    png_infop info = writer ? png_create_info_struct(writer) : nullptr;
    std::vector<std::byte> bytes;
    bool isEncoded = false;
    if (info) {
        png_set_user_limits(writer, kMostSide, kMostSide);
        png_set_write_fn(writer, &bytes, append, [](png_structp) {});
        isEncoded = encode(writer, info, width, height, texels.data());
    }
    png_destroy_write_struct(&writer, &info);
    if (!isEncoded) failPng(failure, fmt::format("{}: the PNG encoder failed: {}", name, failure.why));
    return bytes;
}

} // namespace relume

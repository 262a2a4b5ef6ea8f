#include "engine/base/error.h"
#include "engine/import/image_codecs.h"

#include <csetjmp>
#include <cstdio>
#include <fmt/core.h>
#include <new>
#include <png.h>

namespace relume {

namespace {

// Rendered images compress best, and fastest, as differences from the pixel to the left; levels above 4 take
// several times as long for a tenth less.
constexpr int kFilter = PNG_FILTER_SUB, kLevel = 4;

// Keeps what libpng says of a failure, until an error can be thrown.
struct Failure {
    char why[128] = "";
};

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

[[noreturn]] void leave(png_structp writer, png_const_charp why) {
    Failure& failure = *static_cast<Failure*>(png_get_error_ptr(writer));
    std::snprintf(failure.why, sizeof failure.why, "%s", why);
    png_longjmp(writer, 1);
}

} // namespace

std::vector<std::byte> encodePng(int width, int height, std::span<const uint8_t> texels,
                                 const std::string& name) {
    Failure failure{"there is no memory left"};
    png_structp writer =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, leave, [](png_structp, png_const_charp) {});
    png_infop info = writer ? png_create_info_struct(writer) : nullptr;
    std::vector<std::byte> bytes;
    bool isEncoded = false;
    if (info) {
        constexpr png_uint_32 kMostSide = 0x7fffffff; // of the format; libpng's own limit is a million
        png_set_user_limits(writer, kMostSide, kMostSide);
        png_set_write_fn(writer, &bytes, append, [](png_structp) {});
        isEncoded = encode(writer, info, width, height, texels.data());
    }
    png_destroy_write_struct(&writer, &info);
    if (!isEncoded) throw Error(fmt::format("{}: the PNG encoder failed: {}", name, failure.why));
    return bytes;
}

} // namespace relume

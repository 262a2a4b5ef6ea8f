#include "engine/import/image_file.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/log.h"
#include "engine/import/image_codecs.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr int64_t kMostPixels = int64_t(1) << 28;

bool isFinite(vec4 pixel) {
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z) &&
           std::isfinite(pixel.w);
}

void zeroWhatIsNotFinite(Image& image, const std::string& name) {
    size_t count = 0;
    for (vec4& pixel : image.pixels)
        if (!isFinite(pixel)) {
            pixel = vec4(0);
            count++;
        }
    if (count > 0)
        log(LogLevel::Warning,
            fmt::format("{}: {} pixels are infinite or not a number; they become 0", name, count));
}

// Converts to a byte; NaN becomes 0.
uint8_t quantize(float value) { return value > 0 ? uint8_t(std::lround(255 * std::min(value, 1.0f))) : 0; }

void checkWritable(const Image& image) {
    RELUME_CHECK(image.width > 0 && image.height > 0);
    RELUME_CHECK_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height));
}

} // namespace

void checkImageSize(const std::string& name, int64_t width, int64_t height, size_t bytes) {
    constexpr int64_t kLongestSide = 65536;
    constexpr int64_t kAlwaysFine = int64_t(1) << 22, kPixelsPerByte = 512;
    if (width <= 0 || height <= 0)
        throw Error(fmt::format("{}: expected an image with pixels, found {} x {}", name, width, height));
    if (width > kLongestSide || height > kLongestSide || width * height > kMostPixels)
        throw Error(fmt::format("{}: expected at most {} pixels and {} a side, found {} x {}; scale it down",
                                name, kMostPixels, kLongestSide, width, height));
    if (width * height > kAlwaysFine && uint64_t(width * height) / kPixelsPerByte > bytes)
        throw Error(
            fmt::format("{}: claims {} x {} pixels, more than its {} bytes can hold; get the file again",
                        name, width, height, bytes));
}

void checkDensity(const std::string& name, int64_t width, int64_t height, size_t bytes) {
    constexpr int64_t kAlwaysFine = int64_t(1) << 25, kPixelsPerByte = 16;
    if (width * height > kAlwaysFine && uint64_t(width * height) / kPixelsPerByte > bytes)
        throw Error(fmt::format(
            "{}: holds {} x {} pixels in {} bytes: expected at most {} pixels, or {} a byte; scale it down",
            name, width, height, bytes, kAlwaysFine, kPixelsPerByte));
}

void checkTextureSize(const std::string& name, int64_t width, int64_t height, size_t bytes) {
    if (width > kLongestTextureSide || height > kLongestTextureSide)
        throw Error(
            fmt::format("{}: is {} x {} pixels, expected at most {} a side for a texture: scale it down",
                        name, width, height, kLongestTextureSide));
    checkImageSize(name, width, height, bytes);
}

ImageFile decodeImage(std::span<const std::byte> bytes, const std::string& name) {
    ImageFile file;
    if (isExr(bytes))
        file = decodeExr(bytes, name);
    else if (isRadiance(bytes))
        file.image = decodeRadiance(bytes, name);
    else
        throw Error(
            fmt::format("{}: expected an OpenEXR (.exr) or Radiance (.hdr) image, found neither", name));
    zeroWhatIsNotFinite(file.image, name);
    return file;
}

ImageFile readImage(const std::filesystem::path& path) {
    return decodeImage(readFile(path, size_t(16) << 30), path.string());
}

void writeExr(const std::filesystem::path& path, const Image& image) {
    checkWritable(image);
    writeFileAtomically(path, encodeExr(image));
}

void writePng(const std::filesystem::path& path, const Image& image) {
    checkWritable(image);
    std::vector<uint8_t> texels;
    texels.reserve(4 * image.pixels.size());
    for (const vec4& pixel : image.pixels)
        for (int c = 0; c < 4; c++) texels.push_back(quantize(pixel[c]));
    writeFileAtomically(path, encodePng(image.width, image.height, texels, path.string()));
}

} // namespace relume

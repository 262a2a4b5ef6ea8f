#include "engine/import/texture_file.h"
#include "engine/scene/texture.h"

#include "engine/base/error.h"
#include "tests/support/failure.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_samples.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <limits>
#include <random>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

using namespace relume;
using namespace relume::test;

namespace {

Texture decode(const std::string& bytes, bool srgb = false) {
    return decodeTexture(std::as_bytes(std::span(bytes)), "picture", srgb);
}

std::string textureFailure(const std::string& bytes) {
    return failureOf([&] { decode(bytes); });
}

bool isNear(vec4 a, vec4 b, float tolerance = 1e-5f) { return glm::distance(a, b) < tolerance; }

// A picture large enough for all of JPEG's tables.
Texture gradient() {
    Texture texture{40, 24, {}, false};
    for (uint32_t y = 0; y < 24; y++)
        for (uint32_t x = 0; x < 40; x++) texture.texels.push_back(6 * x | 10 * y << 8 | 0xff800000);
    return texture;
}

// Returns the most bytes that this process has held since resetPeakMemory(), which returns what it holds now.
size_t peakMemory() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) << 10;
    return 0;
}

size_t resetPeakMemory() {
    std::ofstream("/proc/self/clear_refs") << 5;
    return peakMemory();
}

} // namespace

TEST_CASE("texture: bilinear between centers, repeating on all sides") {
    const Texture texture{2, 2, {0xff0000ff, 0x0000ff00, 0x00ff0000, 0x00000000}, false};
    CHECK(isNear(sample(texture, {0.25f, 0.25f}), {1, 0, 0, 1}));
    CHECK(isNear(sample(texture, {0.75f, 0.25f}), {0, 1, 0, 0}));
    CHECK(isNear(sample(texture, {0.25f, 0.75f}), {0, 0, 1, 0}));
    CHECK(isNear(sample(texture, {0.5f, 0.25f}), {0.5f, 0.5f, 0, 0.5f}));
    CHECK(isNear(sample(texture, {0, 0}), {0.25f, 0.25f, 0.25f, 0.25f}));
    CHECK(isNear(sample(texture, {-0.75f, 7.25f}), {1, 0, 0, 1}));
    CHECK(isNear(sample(texture, {0.95f, 0.25f}), {0.4f, 0.6f, 0, 0.4f}));
    for (const float bad :
         {std::numeric_limits<float>::infinity(), NAN, -1e-9f, 1e30f, std::nextafter(1.0f, 0.0f)})
        CHECK(glm::dot(sample(texture, {bad, bad}), vec4(1)) <= 2);
    CHECK(isNear(meanOf(texture), vec4(0.25f)));
}

TEST_CASE("texture: a mip level is the mean of what it covers, decoded first") {
    const Texture checker{2, 2, {0xff000000, 0x00ffffff, 0x00ffffff, 0xff000000}, true};
    const Texture half = halve(checker);
    REQUIRE(half.texelCount() == 1);
    CHECK(half.srgb);
    CHECK(isNear(fetch(half, 0, 0), vec4(0.5f), 0.01f)); // not the 0.21 of an encoded 0.5
    CHECK(half.texels[0] == 0x80bcbcbc);
    // Odd sides: two texels of two and a half each, then one of two, then none fewer.
    Texture line{5, 1, {0, 30, 60, 90, 120}, false};
    const Texture shorter = halve(line);
    REQUIRE(shorter.width == 2);
    REQUIRE(shorter.height == 1);
    CHECK(shorter.texels == std::vector<uint32_t>{24, 96}); // (0 + 30 + 60 / 2) / 2.5
    CHECK(halve(shorter).texels == std::vector<uint32_t>{60});
    CHECK(halve(halve(shorter)).texels == std::vector<uint32_t>{60});
    // Every byte stays itself.
    for (const bool srgb : {false, true})
        for (uint32_t byte = 0; byte < 256; byte++) {
            const uint32_t texel = byte * 0x01010101;
            CHECK(halve({2, 1, {texel, texel}, srgb}).texels[0] == texel);
        }
    // The mean stays, whatever the sides.
    Texture noise{37, 21, {}, false};
    std::mt19937 random(4);
    for (size_t i = 0; i < noise.texelCount(); i++) noise.texels.push_back(random());
    CHECK(isNear(meanOf(halve(noise)), meanOf(noise), 0.002f));
    CHECK(isNear(meanOf(halve(halve(noise))), meanOf(noise), 0.003f));
}

TEST_CASE("texture: over a pixel it is the mean of what the pixel sees") {
    // Stripes of 4 texels along v, of sums of waves along u.
    Texture texture{256, 256, {}, false};
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 256; x++)
            texture.texels.push_back((x / 4 % 2 ? 255u : 0u) | uint32_t(128 + 100 * std::sin(x * 0.1f)) << 8 |
                                     (y / 4 % 2 ? 255u : 0u) << 16);
    const std::vector<Texture> levels = makeMipLevels(texture);
    CHECK(levels.size() == 9);
    const auto meanOver = [&](vec2 uv, vec2 right, vec2 down) {
        vec4 sum(0);
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 64; i++) {
                const vec2 place = (vec2(i, j) + 0.5f) / 64.0f - 0.5f;
                sum += sample(texture, uv + place.x * right + place.y * down);
            }
        return sum / 4096.0f;
    };
    const float texel = 1 / 256.0f;
    // No larger than a texel: bilinear, as ever.
    for (const vec2 uv : {vec2(0.3f, 0.7f), vec2(0.123f, 0.456f)})
        CHECK(sampleFootprint(levels, uv, {0.9f * texel, 0}, {0, -0.7f * texel}) == sample(texture, uv));
    CHECK(sampleFootprint(levels, vec2(0.3f), vec2(0), vec2(0)) == sample(texture, vec2(0.3f)));
    // Long across the stripes of R, and no wider than a texel along them: G and B stay as sharp as they are.
    for (const float v : {0.1f, 0.2f, 0.503f}) {
        const vec4 found = sampleFootprint(levels, {0.4f, v}, {0, texel}, {16 * texel, 0});
        CHECK(isNear(found, meanOver({0.4f, v}, {16 * texel, 0}, {0, texel}), 0.12f));
        CHECK(found.x == doctest::Approx(0.5).epsilon(0.1));
        CHECK(std::abs(found.z - 0.5f) > 0.4f);
    }
    // Both neighbors in the same direction, so that the pixel is a line.
    CHECK(sampleFootprint(levels, {0.4f, 0.1f}, {8 * texel, 0}, {8 * texel, 0}).x ==
          doctest::Approx(0.5).epsilon(0.1));
    // As wide as long: a mip level, whose filter is wider than the pixel.
    CHECK(isNear(sampleFootprint(levels, vec2(0.4f), {32 * texel, 0}, {0, 32 * texel}),
                 meanOver(vec2(0.4f), {32 * texel, 0}, {0, 32 * texel}), 0.15f));
    // Absurd ones are the mean of all.
    const float huge = std::numeric_limits<float>::max();
    CHECK(isNear(sampleFootprint(levels, vec2(0.4f), vec2(huge), vec2(-huge, huge)), meanOf(texture), 0.05f));
}

TEST_CASE("texture: sRGB is decoded before interpolation, alpha never") {
    const Texture texture{2, 1, {0xff000000, 0x00ffffff}, true};
    CHECK(isNear(sample(texture, {0.5f, 0.5f}), vec4(0.5f)));
    const Texture gray{1, 1, {0x80808080}, true};
    CHECK(isNear(sample(gray, {0.3f, 0.3f}), {0.215861f, 0.215861f, 0.215861f, 128 / 255.0f}));
    const Texture dark{1, 1, {0x00000005}, true};
    CHECK(fetch(dark, 0, 0).x == doctest::Approx(5 / 255.0 / 12.92));
}

TEST_CASE("texture: PNG exactly, JPEG nearly, from a file or from bytes") {
    const Texture texture = gradient();
    const Texture png = decode(samplePng(texture), true);
    CHECK(png.width == 40);
    CHECK(png.height == 24);
    CHECK(png.srgb);
    CHECK(png.texels == texture.texels);
    const Texture jpeg = decode(sampleJpeg(texture));
    REQUIRE(jpeg.texelCount() == texture.texelCount());
    for (int i = 0; i < 24; i++) {
        const vec4 expected(vec3(fetch(texture, i, i)), 0); // a linear image without alpha
        CHECK(isNear(fetch(jpeg, i, i), expected, 0.05f));
    }
    const TemporaryFolder folder;
    CHECK(readTexture(folder.write("a.png", samplePng(texture)), false).texels == texture.texels);
    CHECK_THROWS_AS(readTexture(folder.path() / "missing.png", false), Error);
}

TEST_CASE("texture: truncated, absurd and foreign files") {
    const std::string png = samplePng(gradient()), jpeg = sampleJpeg(gradient());
    for (const std::string& file : {png, jpeg})
        for (size_t size = 0; size < file.size(); size++)
            CHECK(textureFailure(file.substr(0, size)).find("picture") != std::string::npos);
    CHECK(textureFailure("GIF89a").find("PNG or JPEG") != std::string::npos);
    // The header's claim, with a check sum that agrees.
    CHECK(textureFailure(samplePngHeader(100000, 100000) + png.substr(33)).find("picture") !=
          std::string::npos);
    CHECK(textureFailure(samplePngHeader(60000, 60000) + png.substr(33))
              .find("60000 x 60000 pixels, expected at most") != std::string::npos);
    CHECK(textureFailure(samplePngHeader(8193, 1) + png.substr(33)).find("8192") != std::string::npos);
    CHECK(textureFailure(samplePngHeader(8192, 8192) + png.substr(33)).find("hold") != std::string::npos);
    CHECK(textureFailure(samplePngHeader(0, 4) + png.substr(33)) != "");
    CHECK(textureFailure(samplePngHeader(40, 25) + png.substr(33)) != "");
    for (size_t i = 0; i < png.size(); i++) {
        std::string damaged = png;
        damaged[i] ^= 1;
        CHECK(textureFailure(damaged).find("picture") != std::string::npos);
    }
    CHECK(textureFailure(png + "after the end") == "");
    // More bytes than a texture may have are not even looked at.
    CHECK(says(
        failureOf([] {
            decodeTexture({static_cast<const std::byte*>(nullptr), (size_t(1) << 29) + 1}, "picture", true);
        }),
        "expected at most"));
}

#ifndef RELUME_SANITIZE // sanitizers reserve more than there is
TEST_CASE("texture: a PNG's size is checked before there is memory for its rows") {
    const std::string file =
        samplePngHeader(12'000'000, 1) + samplePng(gradient()).substr(33); // 200 MB in libpng
    size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit usual;
    REQUIRE(getrlimit(RLIMIT_AS, &usual) == 0);
    const rlimit scarce{pages * size_t(sysconf(_SC_PAGESIZE)) + (size_t(64) << 20), usual.rlim_max};
    REQUIRE(setrlimit(RLIMIT_AS, &scarce) == 0);
    std::string failure;
    try {
        failure = textureFailure(file);
    } catch (...) { // fails the check below, with the usual limit
    }
    setrlimit(RLIMIT_AS, &usual);
    CHECK(failure.find("12000000 x 1 pixels") != std::string::npos);
}
#endif

TEST_CASE("texture: texts in a PNG are not unpacked") {
    const std::string text(size_t(7) << 20, ' '); // libpng unpacks texts of up to 8 MB
    uLongf packedBytes = 60000;
    std::string packed(packedBytes, '\0');
    REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &packedBytes,
                     reinterpret_cast<const Bytef*>(text.data()), text.size()) == Z_OK);
    const std::string content = std::string("Title\0\0", 7) + packed.substr(0, packedBytes); // 0: deflate
    std::string chunk = std::string("\0\0\0\0zTXt", 8) + content + "sum.";
    chunk[2] = char(content.size() >> 8);
    chunk[3] = char(content.size());
    std::string file = samplePng(gradient());
    for (int copy = 0; copy < 40; copy++) file.insert(33, chunk);
    resealPng(file);
    const size_t before = resetPeakMemory();
    CHECK(textureFailure(file) == "");
    CHECK(peakMemory() - before < size_t(32) << 20);
}

TEST_CASE("texture: JPEG tables that overflow or are missing") {
    const std::string jpeg = sampleJpeg(gradient());
    const size_t huffman = jpeg.find("\xff\xc4"), scan = jpeg.find("\xff\xda");
    REQUIRE(huffman != std::string::npos);
    REQUIRE(scan > huffman);
    CHECK(textureFailure(jpeg.substr(0, huffman) + jpeg.substr(scan)).find("missing") != std::string::npos);
    std::string crowded = jpeg;
    crowded[huffman + 5] = char(3); // codes of one bit
    CHECK(textureFailure(crowded).find("codes") != std::string::npos);
    const std::string many =
        std::string("\xff\xc4\x01\x13\x00", 5) + std::string(14, '\0') + "\x80\xff" + std::string(383, 'x');
    CHECK(textureFailure(jpeg.substr(0, huffman) + many + jpeg.substr(huffman)) != "");
    std::string symbols =
        std::string("\xff\xc4\x01\x14\x00", 5) + std::string(16, '\0') + std::string(257, 'x');
    symbols[5 + 8] = char(255); // codes of nine bits
    symbols[5 + 9] = char(2);
    CHECK(says(textureFailure(jpeg.substr(0, huffman) + symbols + jpeg.substr(huffman)),
               "more than 256 symbols"));
    std::string components = jpeg;
    components[scan + 4] = char(255);
    CHECK(says(textureFailure(components), "more than four components"));
    std::string tall = jpeg;
    const size_t size = jpeg.find("\xff\xc0") + 5;
    tall.replace(size, 4, std::string("\x40\0\0\x08", 4)); // 16384 lines of eight
    CHECK(says(textureFailure(tall), "at most 8192 a side"));
    const size_t quantization = jpeg.find("\xff\xdb"), frame = jpeg.find("\xff\xc0");
    CHECK(textureFailure(jpeg.substr(0, quantization) + jpeg.substr(frame)).find("not described") !=
          std::string::npos);
}

TEST_CASE("texture: with any bit flipped, a texture or an Error") {
    std::mt19937 random(5);
    for (const std::string& file : {samplePng(gradient()), sampleJpeg(gradient())})
        for (int i = 0; i < 2000; i++) {
            std::string damaged = file;
            for (int flips = 1 + i % 3; flips > 0; flips--)
                damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
            textureFailure(damaged);
        }
}

TEST_CASE("texture: where a file has no alpha, a color is opaque and a fourth weight nothing") {
    const unsigned char pixel[3] = {10, 20, 30};
    std::string png;
    stbi_write_png_to_func(appendTo, &png, 1, 1, 3, pixel, 0);
    const auto bytes = std::as_bytes(std::span(png));
    CHECK(decodeTexture(bytes, "rgb", true).texels[0] == 0xff1e140a);
    CHECK(decodeTexture(bytes, "rgb", false).texels[0] == 0x001e140a);
    const Texture withAlpha{1, 1, {0x801e140a}, false};
    const std::string four = samplePng(withAlpha);
    CHECK(decodeTexture(std::as_bytes(std::span(four)), "rgba", false).texels == withAlpha.texels);
}

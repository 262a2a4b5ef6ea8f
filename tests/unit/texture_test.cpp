#include "engine/import/texture_file.h"
#include "engine/scene/texture.h"

#include "engine/base/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture_samples.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

Texture decode(const std::string& bytes, bool srgb = false) {
    return decodeTexture(std::as_bytes(std::span(bytes)), "picture", srgb);
}

std::string failureOf(const std::string& bytes) {
    try {
        decode(bytes);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

bool isNear(vec4 a, vec4 b, float tolerance = 1e-5f) { return glm::distance(a, b) < tolerance; }

// A picture large enough for all of JPEG's tables.
Texture gradient() {
    Texture texture{40, 24, {}, false};
    for (uint32_t y = 0; y < 24; y++)
        for (uint32_t x = 0; x < 40; x++) texture.texels.push_back(6 * x | 10 * y << 8 | 0xff800000);
    return texture;
}

} // namespace

TEST_CASE("texture: bilinear between centres, repeating on all sides") {
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

TEST_CASE("texture: sRGB is decoded before interpolation, alpha never") {
    const Texture texture{2, 1, {0xff000000, 0x00ffffff}, true};
    CHECK(isNear(sample(texture, {0.5f, 0.5f}), vec4(0.5f)));
    const Texture grey{1, 1, {0x80808080}, true};
    CHECK(isNear(sample(grey, {0.3f, 0.3f}), {0.215861f, 0.215861f, 0.215861f, 128 / 255.0f}));
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
            CHECK(failureOf(file.substr(0, size)).find("picture") != std::string::npos);
    CHECK(failureOf("GIF89a").find("PNG or JPEG") != std::string::npos);
    // The header's claim, with a check sum that agrees.
    CHECK(failureOf(samplePngHeader(100000, 100000) + png.substr(33)).find("picture") != std::string::npos);
    CHECK(failureOf(samplePngHeader(60000, 60000) + png.substr(33))
              .find("60000 x 60000 pixels, expected at most") != std::string::npos);
    CHECK(failureOf(samplePngHeader(8193, 1) + png.substr(33)).find("8192") != std::string::npos);
    CHECK(failureOf(samplePngHeader(8192, 8192) + png.substr(33)).find("hold") != std::string::npos);
    CHECK(failureOf(samplePngHeader(0, 4) + png.substr(33)) != "");
    CHECK(failureOf(samplePngHeader(40, 25) + png.substr(33)) != "");
    std::string damaged = png;
    damaged[50] ^= 1;
    CHECK(failureOf(damaged).find("check sum") != std::string::npos);
    CHECK(failureOf(png + "after the end") == "");
}

TEST_CASE("texture: JPEG tables that overflow or are missing") {
    const std::string jpeg = sampleJpeg(gradient());
    const size_t huffman = jpeg.find("\xff\xc4"), scan = jpeg.find("\xff\xda");
    REQUIRE(huffman != std::string::npos);
    REQUIRE(scan > huffman);
    CHECK(failureOf(jpeg.substr(0, huffman) + jpeg.substr(scan)).find("missing") != std::string::npos);
    std::string crowded = jpeg;
    crowded[huffman + 5] = char(3); // codes of one bit
    CHECK(failureOf(crowded).find("codes") != std::string::npos);
    const std::string many =
        std::string("\xff\xc4\x01\x13\x00", 5) + std::string(14, '\0') + "\x80\xff" + std::string(383, 'x');
    CHECK(failureOf(jpeg.substr(0, huffman) + many + jpeg.substr(huffman)) != "");
    const size_t quantisation = jpeg.find("\xff\xdb"), frame = jpeg.find("\xff\xc0");
    CHECK(failureOf(jpeg.substr(0, quantisation) + jpeg.substr(frame)).find("not described") !=
          std::string::npos);
}

TEST_CASE("texture: with any bit flipped, a texture or an Error") {
    std::mt19937 random(5);
    for (const std::string& file : {samplePng(gradient()), sampleJpeg(gradient())})
        for (int i = 0; i < 2000; i++) {
            std::string damaged = file;
            for (int flips = 1 + i % 3; flips > 0; flips--)
                damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
            failureOf(damaged);
        }
}

TEST_CASE("texture: where a file has no alpha, a colour is opaque and a fourth weight nothing") {
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

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/exr_check.h"
#include "engine/import/image_codecs.h"
#include "tests/support/capture_binding.h"
#include "tests/support/exr_sample.h"
#include "tests/support/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <optional>
#include <random>
#include <stb_image.h>
#include <stb_image_write.h>

using namespace relume;

namespace {

using Bytes = std::vector<std::byte>;
const test::TemporaryFolder folder;

Image randomImage(int width, int height) {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss;
    Image image(width, height);
    for (vec4& pixel : image.pixels) pixel = {gauss(random), gauss(random), 1e6f * gauss(random), 1};
    return image;
}

ImageFile readBytes(const Bytes& bytes) { return decodeImage(bytes, "bytes"); }

ImageFile readText(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return readBytes({bytes.begin(), bytes.end()});
}

Bytes exrBytes(const Image& image) {
    writeExr(folder.path() / "image.exr", image);
    return readFile(folder.path() / "image.exr");
}

// Radiance bytes as stb writes them: run-length encoded from 8 pixels a row.
Bytes radianceBytes(const Image& image) {
    std::vector<float> rgb;
    for (const vec4& pixel : image.pixels)
        for (int c = 0; c < 3; c++) rgb.push_back(pixel[c]);
    Bytes bytes;
    const auto append = [](void* target, void* data, int size) {
        const auto* first = static_cast<const std::byte*>(data);
        static_cast<Bytes*>(target)->insert(static_cast<Bytes*>(target)->end(), first, first + size);
    };
    stbi_write_hdr_to_func(append, &bytes, image.width, image.height, 3, rgb.data());
    return bytes;
}

// Every reading of damaged bytes must end in an image or in an Error; anything else fails the test.
bool readsOrThrows(const Bytes& bytes) {
    try {
        readBytes(bytes);
    } catch (const Error&) {
    }
    return true;
}

void checkTruncations(const Bytes& bytes) {
    for (size_t length = 0; length < bytes.size(); length++)
        CHECK_THROWS_AS(readBytes({bytes.begin(), bytes.begin() + std::ptrdiff_t(length)}), Error);
}

void checkBitFlips(const Bytes& bytes, int count) {
    std::mt19937 random(2);
    for (int i = 0; i < count; i++) {
        Bytes damaged = bytes;
        for (unsigned flips = 1 + random() % 3; flips > 0; flips--)
            damaged[random() % damaged.size()] ^= std::byte(1u << random() % 8);
        CHECK(readsOrThrows(damaged));
    }
}

// Overwrites the value of an attribute of the header, `offset` bytes into it.
void patchAttribute(Bytes& bytes, const std::string& nameAndType, size_t offset, int32_t value) {
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const size_t place = std::string_view(text, bytes.size()).find(nameAndType);
    REQUIRE(place != std::string_view::npos);
    std::memcpy(bytes.data() + place + nameAndType.size() + 4 + offset, &value, sizeof value);
}

const std::string kDataWindow("dataWindow\0box2i\0", 17);

ImageFile readHalves(const Imf::Header& header, const std::vector<const char*>& names) {
    test::writeHalves(folder.path() / "halves.exr", header, names);
    return readImage(folder.path() / "halves.exr");
}

} // namespace

TEST_CASE("image file: OpenEXR keeps floats exactly, in the same bytes each time") {
    const Image image = randomImage(37, 21);
    const Bytes bytes = exrBytes(image);
    const ImageFile file = readBytes(bytes);
    CHECK(file.projection == ImageProjection::None);
    REQUIRE(file.image.width == 37);
    REQUIRE(file.image.height == 21);
    CHECK(file.image.pixels == image.pixels);
    CHECK(exrBytes(image) == bytes);
}

TEST_CASE("image file: pixels that are not finite become 0") {
    Image image = randomImage(4, 4);
    image.at(1, 0).x = std::numeric_limits<float>::infinity();
    image.at(2, 3).z = std::nanf("");
    const ImageFile file = readBytes(exrBytes(image));
    CHECK(file.image.at(1, 0) == vec4(0));
    CHECK(file.image.at(2, 3) == vec4(0));
    CHECK(file.image.at(0, 0) == image.at(0, 0));
}

TEST_CASE("image file: OpenEXR halves, tiles, offset windows and single channels") {
    const ImageFile color = readHalves(Imf::Header(6, 4), {"R", "G", "B"});
    CHECK(color.image.at(2, 3) == vec4(32, 33, 34, 1));

    Imf::Header tiled(6, 4);
    tiled.setTileDescription(Imf::TileDescription(4, 2));
    CHECK(readHalves(tiled, {"R", "G", "B", "A"}).image.at(5, 3) == vec4(35, 36, 37, 38));

    const Imf::Header shifted(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({-3, 7}, {2, 10}));
    const ImageFile window = readHalves(shifted, {"R", "G", "B"});
    CHECK(window.image.width == 6);
    CHECK(window.image.at(1, 1) == vec4(11, 12, 13, 1));

    CHECK(readHalves(Imf::Header(6, 4), {"Y"}).image.at(2, 1) == vec4(12, 12, 12, 1));
    CHECK(readHalves(Imf::Header(6, 4), {"G"}).image.at(2, 1) == vec4(0, 12, 0, 1));
}

TEST_CASE("image file: OpenEXR says what its pixels map") {
    Imf::Header header(8, 4);
    Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
    CHECK(readHalves(header, {"R", "G", "B"}).projection == ImageProjection::LatLong);
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    CHECK(readHalves(header, {"R", "G", "B"}).projection == ImageProjection::Cube);
}

TEST_CASE("image file: OpenEXR that cannot be used is refused") {
    CHECK_THROWS_AS(readHalves(Imf::Header(4, 4), {"depth.Z"}), Error);
    CHECK_THROWS_AS(readHalves(Imf::Header(4, 4), {"BY", "RY", "Y"}), Error);
    const Bytes bytes = exrBytes(randomImage(16, 8));
    for (unsigned flag : {0x08u, 0x10u}) { // deep, multi-part
        Bytes other = bytes;
        other[5] |= std::byte(flag);
        CHECK_THROWS_AS(readBytes(other), Error);
    }
    const std::string type("type\0string\0\x09\0\0\0hologram!", 25);
    Bytes strange = bytes;
    strange.insert(strange.begin() + 8, reinterpret_cast<const std::byte*>(type.data()),
                   reinterpret_cast<const std::byte*>(type.data()) + type.size());
    CHECK_THROWS_WITH_AS(readBytes(strange), doctest::Contains("a part of type hologram!"), Error);
    // The first channel is A; its xSampling is 8 bytes behind its name, its ySampling 12.
    for (size_t sampling : {8u, 12u}) {
        Bytes coarse = bytes;
        patchAttribute(coarse, std::string("channels\0chlist\0", 16), 2 + sampling, 2);
        CHECK_THROWS_WITH_AS(readBytes(coarse), doctest::Contains("channel A is subsampled"), Error);
    }
}

TEST_CASE("image file: claims beyond what the file can hold are refused") {
    const Bytes bytes = exrBytes(randomImage(16, 8));
    for (int32_t side : {1 << 16, 1 << 20, 1 << 29, std::numeric_limits<int32_t>::max(), -5}) {
        Bytes wide = bytes, high = bytes;
        patchAttribute(wide, kDataWindow, 8, side);
        CHECK_THROWS_AS(readBytes(wide), Error);
        patchAttribute(high, kDataWindow, 12, side);
        CHECK_THROWS_AS(readBytes(high), Error);
        patchAttribute(high, kDataWindow, 8, side);
        CHECK_THROWS_AS(readBytes(high), Error);
    }
    Bytes large = bytes;
    patchAttribute(large, kDataWindow, 8, (1 << 14) - 1);
    patchAttribute(large, kDataWindow, 12, (1 << 14) - 1);
    CHECK_THROWS_AS(readBytes(large), Error);
    // Zeros compress as far, and take gigabytes in memory.
    large.resize(size_t(1) << 20);
    CHECK_THROWS_WITH_AS(readBytes(large), doctest::Contains("scale it down"), Error);
    Imf::Header tiled(6, 4);
    tiled.setTileDescription(Imf::TileDescription(4, 2));
    test::writeHalves(folder.path() / "tiled.exr", tiled, {"R", "G", "B"});
    const Bytes tiles = readFile(folder.path() / "tiled.exr");
    for (int32_t side : {0, 1, 1 << 20, 1 << 30, -1}) {
        Bytes patched = tiles;
        patchAttribute(patched, std::string("tiles\0tiledesc\0", 15), 0, side);
        CHECK(readsOrThrows(patched));
    }
    Bytes patched = tiles; // a tile of 200 MB
    patchAttribute(patched, std::string("tiles\0tiledesc\0", 15), 0, 1 << 24);
    CHECK_THROWS_WITH_AS(readBytes(patched), doctest::Contains("claims chunks"), Error);
    // Tiles of no width, in a file of lines.
    patched = tiles;
    patchAttribute(patched, std::string("tiles\0tiledesc\0", 15), 0, 0);
    patched[5] &= std::byte(~2); // the flag
    CHECK(readsOrThrows(patched));
}

TEST_CASE("image file: damaged OpenEXR is an error, never a crash") {
    checkTruncations(exrBytes(randomImage(5, 3)));
    checkBitFlips(exrBytes(randomImage(16, 9)), 1500);
    for (Imf::Compression compression : {Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION,
                                         Imf::B44A_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        Imf::Header header(20, 10);
        header.compression() = compression;
        test::writeHalves(folder.path() / "halves.exr", header, {"R", "G", "B"});
        checkBitFlips(readFile(folder.path() / "halves.exr"), 300);
    }
    Imf::Header tiled(20, 10);
    tiled.setTileDescription(Imf::TileDescription(8, 4));
    test::writeHalves(folder.path() / "halves.exr", tiled, {"R", "G", "B"});
    checkBitFlips(readFile(folder.path() / "halves.exr"), 300);
}

TEST_CASE("image file: an OpenEXR chunk that unpacks to less than its pixels is refused") {
    const std::string runs("\x03\x07", 2),
        deflated("x\x9c\x63\x60\x60\x60\0\0\0\x04\0\x01", 12); // four bytes
    for (const bool isTiled : {false, true})
        for (const auto& [compression, packed] : {std::pair(Imf::NO_COMPRESSION, std::string(60, '\x3c')),
                                                  {Imf::RLE_COMPRESSION, runs},
                                                  {Imf::ZIPS_COMPRESSION, deflated},
                                                  {Imf::ZIP_COMPRESSION, deflated},
                                                  {Imf::PIZ_COMPRESSION, ""},
                                                  {Imf::PXR24_COMPRESSION, ""},
                                                  {Imf::B44_COMPRESSION, ""},
                                                  {Imf::B44A_COMPRESSION, ""},
                                                  {Imf::DWAA_COMPRESSION, ""},
                                                  {Imf::DWAB_COMPRESSION, ""}}) {
            CAPTURE(isTiled);
            CAPTURE_BINDING(int(compression));
            Imf::Header header(20, 18);
            header.compression() = compression;
            if (isTiled) header.setTileDescription(Imf::TileDescription(16, 4));
            test::writeHalves(folder.path() / "halves.exr", header, {"R", "G", "B"});
            Bytes bytes = readFile(folder.path() / "halves.exr");
            CHECK(readBytes(bytes).image.at(19, 17).z == doctest::Approx(191).epsilon(0.02));
            // The first chunk, of which the table after the header says where it starts.
            uint64_t start;
            std::memcpy(&start, &bytes[checkExrHeader(bytes, "bytes")], sizeof start);
            start += isTiled ? 16 : 4;
            const auto size = int32_t(packed.size());
            std::memcpy(&bytes[start], &size, sizeof size);
            std::memcpy(&bytes[start + sizeof size], packed.data(), packed.size());
            CHECK_THROWS_WITH_AS(readBytes(bytes), doctest::Contains("do not unpack"), Error);
        }
}

TEST_CASE("image file: OpenEXR chunks are where the library looks for them") {
    const auto written = [](Imf::LineOrder order, std::optional<Imf::TileDescription> tiles = std::nullopt) {
        Imf::Header header(20, 18);
        header.compression() = Imf::RLE_COMPRESSION;
        header.lineOrder() = order;
        if (tiles) header.setTileDescription(*tiles);
        test::writeHalves(folder.path() / "halves.exr", header, {"R", "G", "B"});
        return readFile(folder.path() / "halves.exr");
    };
    const Imf::TileDescription tiles(8, 4), mipmaps(8, 4, Imf::MIPMAP_LEVELS);
    for (const Bytes& bytes : {written(Imf::INCREASING_Y), written(Imf::DECREASING_Y),
                               written(Imf::INCREASING_Y, tiles), written(Imf::DECREASING_Y, tiles)})
        CHECK(readBytes(bytes).image.at(19, 17) == vec4(189, 190, 191, 1));

    const auto tableOf = [](Bytes& bytes) { return &bytes[checkExrHeader(bytes, "bytes")]; };
    // The library reads the lines that follow the first ones, not those that the table names.
    Bytes moved = written(Imf::INCREASING_Y);
    std::array<uint64_t, 3> starts;
    std::memcpy(starts.data(), tableOf(moved), sizeof starts);
    const Bytes chunk(&moved[starts[1]], &moved[starts[2]]);
    starts[1] = moved.size();
    std::memcpy(tableOf(moved), starts.data(), sizeof starts);
    moved.insert(moved.end(), chunk.begin(), chunk.end());
    CHECK_THROWS_WITH_AS(readBytes(moved), doctest::Contains("follow one another"), Error);

    Bytes repeated = written(Imf::INCREASING_Y, tiles);
    std::memcpy(tableOf(repeated) + 8, tableOf(repeated), 8); // a tile in two places
    CHECK_THROWS_WITH_AS(readBytes(repeated), doctest::Contains("another place"), Error);
    // Levels that were not written: the library would make a table of what it finds.
    CHECK_THROWS_WITH_AS(readBytes(written(Imf::INCREASING_Y, mipmaps)), doctest::Contains("lacks pixels"),
                         Error);
}

TEST_CASE("image file: OpenEXR attributes of other sizes than their types have are refused") {
    // OpenEXR reads four bytes of an int, whatever its size says, and would take what follows for an
    // attribute of almost 2 GB.
    const std::string start("\x76\x2f\x31\x01\x02\0\0\0", 8);
    const auto attribute = [](const std::string& type, const std::string& value) {
        const auto size = uint32_t(value.size());
        std::string text("a\0", 2);
        text += type;
        text += '\0';
        for (int shift = 0; shift < 32; shift += 8) text += char(size >> shift);
        return text + value;
    };
    const std::string large("\0\0\0\0b\0other\0\x7f\x7f\x7f\x6f", 16);
    for (const char* type :
         {"int", "float", "box2i", "chlist", "preview", "stringvector", "floatvector", "tiledesc"}) {
        CAPTURE(type);
        const std::string file = start + attribute(type, large + std::string(1, '\0')) + std::string(1, '\0');
        CHECK_THROWS_WITH_AS(readText(file), doctest::Contains("damaged OpenEXR header"), Error);
    }
    CHECK_THROWS_WITH_AS(readText(start + attribute("idmanifest", large)), doctest::Contains("idmanifest"),
                         Error);
}

TEST_CASE("image file: Radiance pixels, plain and in run lengths") {
    const std::string header = "#?RADIANCE\n# comment\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 3\n";
    const std::string one = "\x80\x40\x20\x81"; // 1, 0.5, 0.25
    const std::string repeat("\x01\x01\x01\x02", 4), zero(4, '\0');
    const Image plain = readText(header + one + one + zero + zero + one + one).image;
    CHECK(plain.at(1, 0) == vec4(1, 0.5f, 0.25f, 1));
    CHECK(plain.at(2, 0) == vec4(0, 0, 0, 1));
    const Image runs = readText(header + one + repeat + zero + one + one).image;
    CHECK(runs.at(2, 0) == vec4(1, 0.5f, 0.25f, 1));
    CHECK(runs.at(0, 1) == vec4(0, 0, 0, 1));
    CHECK_THROWS_AS(readText(header + repeat + one + one + one + one + one), Error);

    Image image = randomImage(40, 5);
    for (size_t i = 0; i < image.pixels.size(); i++)
        image.pixels[i] = i % 40 < 20 ? vec4(1, 2, 3, 1) : glm::abs(image.pixels[i]);
    const Image read = readBytes(radianceBytes(image)).image;
    for (size_t i = 0; i < image.pixels.size(); i++)
        for (int c = 0; c < 3; c++) {
            const float largest = std::max({image.pixels[i].x, image.pixels[i].y, image.pixels[i].z});
            CHECK(std::abs(read.pixels[i][c] - image.pixels[i][c]) <= largest / 127);
        }
}

TEST_CASE("image file: damaged Radiance is an error, never a crash") {
    const Bytes bytes = radianceBytes(randomImage(12, 3));
    checkTruncations(bytes);
    checkBitFlips(bytes, 2000);
    const std::string header = "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n";
    for (const char* resolution :
         {"", "-Y 0 +X 0\n", "-Y 100000 +X 100000\n", "-Y 16384 +X 16384\n", "-Y 99999999999999999999 +X 1\n",
          "-Y -3 +X 3\n", "+Y 2 +X 2\n", "-Y 2 -X 2\n", "+X 2 -Y 2\n", "-Y 2\n", "-Y 2 +X\n"})
        CHECK_THROWS_AS(readText(header + resolution + std::string(1000, '\x40')), Error);
    CHECK_THROWS_WITH_AS(readText(header + "-Y 8192 +X 8192\n" + std::string(1 << 21, '\x40')),
                         doctest::Contains("scale it down"), Error);
    CHECK_THROWS_AS(readText("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd"), Error);
    // Runs of pixels that are longer than the line, by their count and by how many counts there are.
    const std::string line = header + "-Y 1 +X 2\n" + std::string("\x0a\x0a\x0a\x80", 4);
    for (const std::string& runs :
         {std::string("\1\1\1\0\1\1\1\xff\1\1\1\xff", 12),
          std::string("\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\0\x09\x09\x09\x80", 24)})
        CHECK_THROWS_WITH_AS(readText(line + runs), doctest::Contains("a run of impossible length"), Error);
    // A count of zero makes no progress.
    CHECK_THROWS_AS(
        readText(header + "-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08", 4) + std::string(64, '\0')), Error);
}

TEST_CASE("image file: sizes have limits, whatever the file holds") {
    constexpr size_t kLarge = size_t(1) << 30;
    CHECK_NOTHROW(checkImageSize("a", 65536, 4096, kLarge));
    CHECK_THROWS_WITH_AS(checkImageSize("a", 65536, 65536, kLarge),
                         doctest::Contains("at most 268435456 pixels"), Error);
    CHECK_THROWS_WITH_AS(checkImageSize("a", 65537, 1, kLarge), doctest::Contains("65536"), Error);
    CHECK_THROWS_WITH_AS(checkImageSize("a", 1, 65537, kLarge), doctest::Contains("65536"), Error);
    CHECK_THROWS_WITH_AS(checkTextureSize("a", 1, 9000, kLarge), doctest::Contains("at most 8192 a side"),
                         Error);
    Imf::Header wide(70000, 1);
    wide.compression() = Imf::NO_COMPRESSION;
    CHECK_THROWS_WITH_AS(readHalves(wide, {"G"}), doctest::Contains("65536"), Error);
    Imf::Header tall(1, 70000);
    tall.compression() = Imf::NO_COMPRESSION;
    CHECK_THROWS_WITH_AS(readHalves(tall, {"G"}), doctest::Contains("65536"), Error);
}

TEST_CASE("image file: what is no image is refused") {
    CHECK_THROWS_AS(readText(""), Error);
    CHECK_THROWS_AS(readText("P6 2 2 255 ............"), Error);
    CHECK_THROWS_AS(readImage(folder.path()), Error);
    CHECK_THROWS_AS(readImage(folder.path() / "absent.exr"), Error);
    CHECK_THROWS_AS(writeExr(folder.path() / "absent" / "image.exr", randomImage(2, 2)), Error);
    CHECK_THROWS_AS(writePng(folder.path() / "absent" / "image.png", randomImage(2, 2)), Error);
}

TEST_CASE("image file: a PNG is as wide as an image may be") {
    Image image(1'000'001, 1); // libpng's own limit is a million
    image.at(1'000'000, 0) = vec4(1);
    const auto path = folder.path() / "wide.png";
    writePng(path, image);
    int width, height, channels;
    REQUIRE(stbi_info(path.c_str(), &width, &height, &channels));
    CHECK(width == 1'000'001);
}

TEST_CASE("image file: PNG rounds display values to 8 bits") {
    Image image(3, 2);
    image.at(0, 0) = {0, 0.5f, 1, 1};
    image.at(2, 1) = {-1, 2, std::nanf(""), 0.25f};
    image.at(1, 1) = vec4(100.4f / 255, 100.6f / 255, 0, 1);
    const auto path = folder.path() / "image.png";
    writePng(path, image);
    int width, height, channels;
    stbi_uc* texels = stbi_load(path.c_str(), &width, &height, &channels, 4);
    REQUIRE(texels != nullptr);
    CHECK(width == 3);
    CHECK(height == 2);
    CHECK(channels == 4);
    const auto at = [&](int x, int y, int c) { return int(texels[(y * 3 + x) * 4 + c]); };
    CHECK(at(0, 0, 1) == 128);
    CHECK(at(0, 0, 2) == 255);
    CHECK(at(2, 1, 0) == 0);
    CHECK(at(2, 1, 1) == 255);
    CHECK(at(2, 1, 2) == 0);
    CHECK(at(2, 1, 3) == 64);
    CHECK(at(1, 1, 0) == 100);
    CHECK(at(1, 1, 1) == 101);
    stbi_image_free(texels);
}

// Checks of OpenEXR chunks that the library reads wrongly, or for long: DWAA, DWAB and PIZ, and tiles that
// overlap.
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/exr_check.h"
#include "engine/import/image_codecs.h"
#include "tests/support/exr_sample.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <zlib.h>

namespace relume {

namespace {

using Bytes = std::vector<std::byte>;

struct NamedChannel {
    const char* name;
    Imf::PixelType type;
    int sampling = 1; // a value for so many columns and rows
};

using Channels = std::vector<NamedChannel>;

constexpr size_t kSizesBytes = 11 * sizeof(uint64_t);

// Returns a file whose channels of floats have a wave with noise, the same in all, and others count from 0.
Bytes written(Imf::Header header, const Channels& channels) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "lossy.exr";
    const Imath::Box2i window = header.dataWindow();
    const size_t width = size_t(window.size().x + 1), pixels = width * size_t(window.size().y + 1);
    std::mt19937 random(1);
    std::vector<float> floats(pixels);
    std::vector<uint32_t> numbers(pixels);
    for (uint32_t i = 0; i < pixels; i++) {
        floats[i] =
            0.4f + 0.3f * std::sin(0.1f * float(i)) + std::uniform_real_distribution<float>(0, 0.1f)(random);
        numbers[i] = i;
    }
    const std::vector<half> halves(floats.begin(), floats.end());
    Imf::FrameBuffer source;
    for (const auto& [name, type, sampling] : channels) {
        header.channels().insert(name, Imf::Channel(type, sampling, sampling));
        const void* const base = type == Imf::HALF    ? static_cast<const void*>(halves.data())
                                 : type == Imf::FLOAT ? static_cast<const void*>(floats.data())
                                                      : static_cast<const void*>(numbers.data());
        const size_t bytes = type == Imf::HALF ? 2 : 4;
        source.insert(name, Imf::Slice::Make(type, base, window, bytes, bytes * width, sampling, sampling));
    }
    test::writePlanes(path, header, source);
    return readFile(path);
}

Imf::Header headerOf(int width, int height, Imf::Compression compression) {
    Imf::Header header(width, height);
    header.compression() = compression;
    return header;
}

// Returns where the first chunk of a file of lines begins: its line, its size, then what is packed.
size_t firstChunk(const Bytes& file) {
    uint64_t start;
    std::memcpy(&start, &file[checkExrHeader(file, "file")], sizeof start);
    return size_t(start);
}

// Adds to one of the sizes that the first chunk begins with.
Bytes withMore(Bytes file, size_t place, int64_t more) {
    std::byte* const number = &file[firstChunk(file) + 8 + place * sizeof more];
    int64_t size;
    std::memcpy(&size, number, sizeof size);
    size += more;
    std::memcpy(number, &size, sizeof size);
    return file;
}

// Replaces what is packed in the only chunk of a file of lines.
Bytes withChunk(Bytes file, const std::string& packed) {
    const auto size = int32_t(packed.size());
    const size_t start = firstChunk(file);
    file.resize(start + 8 + packed.size());
    std::memcpy(&file[start + 4], &size, sizeof size);
    std::memcpy(file.data() + start + 8, packed.data(), packed.size());
    return file;
}

std::string deflated(const std::string& bytes) {
    std::string packed(compressBound(bytes.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    packed.resize(size);
    return packed;
}

void checkRefused(const Bytes& file) {
    CHECK_THROWS_WITH_AS(decodeImage(file, "lossy.exr"), doctest::Contains("do not unpack"), Error);
}

// Returns a file of 256 x 32 black pixels, R, G and B, that are one chunk in DWAA, with these rules,
// coefficients (AC) and number of DC coefficients.
Bytes fileOf(const std::string& rules, const std::vector<uint16_t>& coefficients, size_t dcCount) {
    const Bytes file = written(headerOf(256, 32, Imf::DWAA_COMPRESSION),
                               {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}});
    const std::string packed = deflated(
                          {reinterpret_cast<const char*>(coefficients.data()), 2 * coefficients.size()}),
                      packedDc = deflated(std::string(2 * dcCount, '\0'));
    const std::array<uint64_t, 11> sizes = {
        2, 0, 0, packed.size(), packedDc.size(), 0, 0, 0, coefficients.size(), dcCount, 1};
    const std::string chunk =
        std::string(reinterpret_cast<const char*>(sizes.data()), kSizesBytes) + rules + packed + packedDc;
    return withChunk(file, chunk);
}

// Returns values in OpenEXR's Huffman coding: the first and the last symbol, and bits as digits, with spaces.
Bytes huffmanOf(uint32_t first, uint32_t last, std::string code, std::string values) {
    std::erase(code, ' ');
    std::erase(values, ' ');
    const uint32_t numbers[] = {first, last, 0, uint32_t(values.size()), 0};
    Bytes packed(sizeof numbers);
    std::memcpy(packed.data(), numbers, sizeof numbers);
    for (const std::string& bits : {code, values})
        for (size_t i = 0; i < bits.size(); i += 8)
            packed.push_back(std::byte(std::stoi((bits.substr(i, 8) + "0000000").substr(0, 8), nullptr, 2)));
    return packed;
}

// Returns the values, or nothing unless there are `count`.
std::vector<uint16_t> decoded(const Bytes& packed, uint64_t count) {
    std::vector<uint16_t> values;
    const bool isWhole = decodeExrHuffman(packed, count, [&](uint16_t value) { values.push_back(value); });
    return isWhole ? values : std::vector<uint16_t>();
}

} // namespace

TEST_CASE("image file: DWAA and DWAB are read with all channels that the library writes") {
    const Channels colors = {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}},
                   all = {{"R", Imf::FLOAT},     {"G", Imf::HALF},       {"B", Imf::UINT},
                          {"A", Imf::HALF},      {"Z", Imf::FLOAT},      {"id", Imf::UINT},
                          {"left.R", Imf::HALF}, {"left.A", Imf::FLOAT}, {"left.RY", Imf::HALF},
                          {"mask.A", Imf::UINT}, {"Y.", Imf::HALF}},
                   luminance = {{"Y", Imf::HALF}, {"A", Imf::FLOAT}},
                   subsampled = {{"R", Imf::HALF},           {"G", Imf::HALF},         {"B", Imf::HALF},
                                 {"left.BY", Imf::FLOAT, 2}, {"left.A", Imf::HALF, 5}, {"Z", Imf::UINT, 10}};
    const Image whole =
        decodeImage(written(headerOf(70, 300, Imf::NO_COMPRESSION), colors), "whole.exr").image;
    const auto check = [&](const Imf::Header& header, const Channels& channels) {
        const Image image = decodeImage(written(header, channels), "lossy.exr").image;
        CHECK(image.at(0, 0).x == doctest::Approx(whole.at(0, 0).x).epsilon(0.05));
        CHECK(image.at(69, 299).y == doctest::Approx(whole.at(69, 299).y).epsilon(0.05));
    };
    for (const auto compression : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        Imf::Header header = headerOf(70, 300, compression);
        for (const Channels& channels : {colors, all, luminance, subsampled}) check(header, channels);
        header.setTileDescription(Imf::TileDescription(32, 44));
        for (const Channels& channels : {colors, all, luminance}) check(header, channels);
    }
}

TEST_CASE("image file: a DWAA chunk of other sizes or rules than its channels need is refused") {
    const Bytes file =
        written(headerOf(64, 32, Imf::DWAA_COMPRESSION),
                {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}, {"A", Imf::HALF}, {"Z", Imf::HALF}});
    CHECK(decodeImage(file, "lossy.exr").image.at(63, 31).w > 0);
    // The version, bytes of Z and those that they are packed into, bytes of A, AC and DC coefficients,
    // and the compression of AC.
    for (const size_t place : {0, 1, 2, 7, 8, 9, 10})
        for (const int64_t more : {-1, 1, 1 << 20}) {
            CAPTURE(place);
            CAPTURE(more);
            checkRefused(withMore(file, place, more));
        }
    // The bytes that AC coefficients are packed into; the library itself sees one more.
    checkRefused(withMore(file, 3, -1));
    checkRefused(withMore(file, 3, 1 << 20));
    Bytes shortened = file;
    const int32_t size = 40;
    std::memcpy(&shortened[firstChunk(file) + 4], &size, sizeof size);
    checkRefused(shortened);
    const size_t rules = firstChunk(file) + 8 + kSizesBytes;
    const std::string expected("\22\0R\0\24\1G\0\44\1B\0\64\1A\0\10\1", 18);
    REQUIRE(std::memcmp(&file[rules], expected.data(), expected.size()) == 0);
    for (size_t i = 0; i < expected.size(); i++) {
        Bytes changed = file;
        changed[rules + i] ^= std::byte(4);
        checkRefused(changed);
    }
    Bytes changed = file; // within the bytes of Z, which follow
    changed[rules + expected.size() + 8] ^= std::byte(4);
    checkRefused(changed);
}

TEST_CASE("image file: a DWAA chunk has AC coefficients for all blocks") {
    const std::string rules("\16\0R\0\24\1G\0\44\1B\0\64\1", 14);
    constexpr size_t kBlocks = 3 * 32 * 4;
    // The rest of a block, 63 zeros, or a value and 62 zeros.
    std::vector<uint16_t> coefficients(kBlocks - 2, 0xff00);
    coefficients.insert(coefficients.end(), {0xff3f, 0, 0xff3e});
    const Image black = decodeImage(fileOf(rules, coefficients, kBlocks), "lossy.exr").image;
    CHECK(black.at(255, 31).z == 0);
    // A value that is no number takes the place of zeros.
    std::vector<uint16_t> more = coefficients;
    more.push_back(0xff00);
    CHECK(decodeImage(fileOf(rules, more, kBlocks), "lossy.exr").image.at(255, 31).z == 0);
    checkRefused(fileOf(rules, std::vector<uint16_t>(63 * kBlocks + 1, 0xff00), kBlocks));
    checkRefused(withMore(fileOf(rules + "x", coefficients, kBlocks), 2, 1)); // deflated bytes of no channel
    const std::string zeros = deflated(std::string(2 * kBlocks, '\0'));
    Bytes damaged = fileOf(rules, coefficients, kBlocks);
    damaged[damaged.size() - zeros.size() - 1] ^= std::byte(4); // the check sum of coefficients
    checkRefused(damaged);
    coefficients.back() = 0xff3d;
    checkRefused(fileOf(rules, coefficients, kBlocks));
    coefficients.pop_back();
    checkRefused(fileOf(rules, coefficients, kBlocks));
}

TEST_CASE("image file: a DWAA chunk of channels that are not transformed has no coefficients") {
    const Bytes file = written(headerOf(64, 32, Imf::DWAA_COMPRESSION), {{"Y", Imf::UINT}});
    CHECK(decodeImage(file, "lossy.exr").image.at(2, 1).x == 66);
    const std::string chunk(reinterpret_cast<const char*>(&file[firstChunk(file) + 8]),
                            file.size() - firstChunk(file) - 8);
    checkRefused(withMore(withChunk(file, chunk + "x"), 3, 1));
    checkRefused(withMore(file, 4, 1));
    checkRefused(withMore(file, 8, 1));
}

// The library transforms three channels together where rules give them the places 0, 1 and 2, but has room
// for DC coefficients of those channels alone that are transformed.
TEST_CASE("image file: DWAA's rules cannot make the library read beyond its buffers") {
    const std::string rules("\16\0R\0\24\1R\0\44\1R\0\64\1", 14);
    constexpr size_t kBlocks = 32 * 4;
    checkRefused(fileOf(rules, std::vector<uint16_t>(3 * kBlocks, 0xff00), kBlocks));
}

TEST_CASE("image file: OpenEXR's Huffman coding gives its values, or is refused") {
    // Codes of 1, 2 and 2 bits for the symbols 5, 6 and 7: 1, 00 and 01. The last one repeats, 3 times here.
    const std::string code = "000001 000010 000010", values = "1 00 01 00000011";
    CHECK(decoded(huffmanOf(5, 7, code, values), 5) == std::vector<uint16_t>{5, 6, 6, 6, 6});
    // Three symbols without a code, then 6 + 2 of them.
    const std::string gaps = "000001 111100 000010 111111 00000010 000010";
    CHECK(decoded(huffmanOf(5, 18, gaps, values), 5) == std::vector<uint16_t>{5, 9, 9, 9, 9});
    const std::vector<uint16_t> none;
    CHECK(decoded(huffmanOf(5, 7, code, values), 4) == none);
    CHECK(decoded(huffmanOf(5, 7, code, values), 6) == none);
    CHECK(decoded(huffmanOf(5, 7, code, "01 00000011"), 3) == none);         // nothing to repeat
    CHECK(decoded(huffmanOf(5, 7, code, "1 01 000"), 1) == none);            // repeated how often?
    CHECK(decoded(huffmanOf(5, 7, code, "1 0"), 2) == none);                 // half a code
    CHECK(decoded(huffmanOf(5, 7, code, "1 01 00000000 00"), 2) == none);    // repeated 0 times
    CHECK(decoded(huffmanOf(5, 7, "000001 000010 000000", "1"), 1) == none); // 01 is no code
    CHECK(decoded(huffmanOf(5, 6, "000010 000010", "00"), 1) == none);       // nor are 10 and 11
    CHECK(decoded(huffmanOf(5, 8, "000001 000010 000010 000010", "1 01 01"), 3) == none); // 01 is two
    CHECK(decoded(huffmanOf(5, 8, "000001 000001 000001 000001", "1 1 1"), 3) == none);   // 1 is several
    CHECK(decoded(huffmanOf(5, 7, code, "1"), 1) == none);                                // 6 does not occur
    // Symbols without a code that go on beyond the last symbol.
    CHECK(decoded(huffmanOf(5, 8, "000001 000001 111100", "0"), 1) == none);
    CHECK(decoded(huffmanOf(5, 8, "000001 000001 111111 00000000", "0"), 1) == none);
    CHECK(decoded(huffmanOf(5, 8, "000001 000001 111111", ""), 0) == none); // how many more?
    // Codes of 1, 2, 3 bits and so on, the last one twice; 52 is the longest that both decoders read alike.
    const auto ladder = [](int longest) {
        std::string lengths;
        for (int i = 1; i <= longest + 1; i++)
            lengths += std::bitset<6>(uint64_t(std::min(i, longest))).to_string();
        return huffmanOf(0, uint32_t(longest), lengths, std::string(64, '1'));
    };
    CHECK(decoded(ladder(52), 64) == std::vector<uint16_t>(64, 0));
    CHECK(decoded(ladder(53), 64) == none);
    // All values of 16 bits and one that repeats are as many symbols as there are.
    std::string sparse = "000001"; // of the symbol 4; 65,531 have none
    for (int i = 0; i < 251; i++) sparse += "111111 11111111";
    sparse += "111111 00001110 000001";
    CHECK(decoded(huffmanOf(4, 1 << 16, sparse, "0"), 1) == std::vector<uint16_t>{4});
    CHECK(decoded(huffmanOf(5, (1 << 16) + 1, sparse, "0"), 1) == none);
    const Bytes whole = huffmanOf(5, 7, code, values);
    for (size_t size = 0; size < whole.size(); size++)
        CHECK(decoded(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size)), 5) == none);
}

// The library takes seconds for a table of many codes before it finds that values lack.
TEST_CASE("image file: a PIZ chunk of more codes than values is refused") {
    const Bytes file = written(headerOf(20, 2, Imf::PIZ_COMPRESSION), {{"Y", Imf::FLOAT}});
    const auto chunkOf = [&](const Bytes& values) {
        std::string chunk("\xff\x1f\0\0", 4); // no bit map: all values are zero
        const auto size = int32_t(values.size());
        chunk.append(reinterpret_cast<const char*>(&size), sizeof size);
        chunk.append(reinterpret_cast<const char*>(values.data()), values.size());
        return withChunk(file, chunk);
    };
    // 80 values: a zero, and 79 times again.
    std::string of16, of32;
    for (int i = 0; i < 16; i++) of16 += "000100";
    for (int i = 0; i < 32; i++) of32 += "000101";
    const Bytes fewCodes = chunkOf(huffmanOf(0, 15, of16, "0000 1111 01001111"));
    CHECK(decodeImage(fewCodes, "zeros.exr").image.at(19, 1).x == 0);
    checkRefused(chunkOf(huffmanOf(0, 31, of32, "00000 11111 01001111")));
    for (const size_t size : {0, 3, 7}) checkRefused(withChunk(file, std::string(size, '\0')));
}

TEST_CASE("image file: OpenEXR tiles that overlap are refused") {
    Imf::Header header = headerOf(20, 4, Imf::NO_COMPRESSION);
    header.setTileDescription(Imf::TileDescription(16, 4));
    Bytes file = written(header, {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}});
    CHECK(decodeImage(file, "tiles.exr").image.width == 20);
    const size_t table = checkExrHeader(file, "file");
    std::array<uint64_t, 2> tiles;
    std::memcpy(tiles.data(), &file[table], sizeof tiles);
    // The second tile, which is smaller, among the pixels of the first.
    std::copy(file.begin() + std::ptrdiff_t(tiles[1]), file.end(),
              file.begin() + std::ptrdiff_t(tiles[0]) + 40);
    tiles[1] = tiles[0] + 40;
    std::memcpy(&file[table], tiles.data(), sizeof tiles);
    CHECK_THROWS_WITH_AS(decodeImage(file, "tiles.exr"), doctest::Contains("tiles overlap"), Error);
}

} // namespace relume

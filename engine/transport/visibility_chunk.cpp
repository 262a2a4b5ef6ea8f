#include "engine/transport/visibility_chunk.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <array>
#include <bit>
#include <cstring>
#include <fmt/core.h>

namespace relume {

namespace {

using Bytes = std::vector<uint8_t>;

static_assert(std::endian::native == std::endian::little); // words of bits are the device's

constexpr int kLevels = 3; // levels of flags: 512 bytes of bits per byte of the last

uint64_t bitBytes(uint64_t vertices, uint32_t size) { return vertices * 6 * size * size / 8; }

// The nonzero bytes, and one flag per byte that tells which these are.
struct Sparse {
    Bytes flags, kept;
};

Sparse sparse(const Bytes& bytes) {
    Sparse result{Bytes(bytes.size() / 8), Bytes(bytes.size())};
    size_t count = 0;
    for (size_t i = 0; i < result.flags.size(); i++) {
        uint64_t word;
        std::memcpy(&word, &bytes[8 * i], 8);
        if (word == 0) continue;
        for (size_t b = 0; b < 8; b++) {
            const uint8_t byte = bytes[8 * i + b];
            result.flags[i] = uint8_t(result.flags[i] | (byte != 0) << b);
            result.kept[count] = byte; // overwritten if it is zero
            count += byte != 0;
        }
    }
    result.kept.resize(count);
    return result;
}

// Reverses sparse(), taking the bytes from the front of `rest`.
Bytes spread(const Bytes& flags, std::span<const std::byte>& rest, const std::string& where) {
    size_t count = 0;
    for (uint8_t flag : flags) count += size_t(std::popcount(flag));
    if (count > rest.size())
        throw Error(fmt::format("{}: expected {} more bytes, found {}; the file is damaged", where, count,
                                rest.size()));
    const std::byte* next = rest.data();
    rest = rest.subspan(count);
    Bytes bytes(flags.size() * 8);
    for (size_t i = 0; i < flags.size(); i++)
        for (unsigned left = flags[i]; left != 0; left &= left - 1)
            bytes[8 * i + size_t(std::countr_zero(left))] = uint8_t(*next++);
    return bytes;
}

} // namespace

uint64_t largestVisibilityChunk(uint64_t vertices, uint32_t size) {
    uint64_t bytes = bitBytes(vertices, size), sum = bytes;
    for (int level = 0; level < kLevels; level++) sum += bytes /= 8;
    return sum;
}

uint64_t smallestVisibilityChunk(uint64_t vertices, uint32_t size) {
    return bitBytes(vertices, size) >> 3 * kLevels;
}

// Stores each row's difference from the one above. Most rows are equal, so that nearly all bits are zero.
std::vector<std::byte> encodeVisibility(std::span<const uint32_t> bits, uint32_t size) {
    const size_t rowWords = size / 32, vertexWords = 6 * size * rowWords;
    RELUME_CHECK(size % kSmallestKeptVisibility == 0 && bits.size() % vertexWords == 0);
    std::vector<uint32_t> differences(bits.begin(), bits.end());
    for (size_t vertex = 0; vertex < bits.size(); vertex += vertexWords)
        for (size_t word = vertex + rowWords; word < vertex + vertexWords; word++)
            differences[word] = bits[word] ^ bits[word - rowWords];

    Bytes bytes(bits.size_bytes());
    std::memcpy(bytes.data(), differences.data(), bytes.size());
    std::array<Bytes, kLevels> kept;
    for (Bytes& level : kept) {
        Sparse reduced = sparse(bytes);
        level = std::move(reduced.kept);
        bytes = std::move(reduced.flags);
    }
    for (int level = kLevels - 1; level >= 0; level--)
        bytes.insert(bytes.end(), kept[size_t(level)].begin(), kept[size_t(level)].end());
    const auto coded = std::as_bytes(std::span(bytes));
    return {coded.begin(), coded.end()};
}

std::vector<uint32_t> decodeVisibility(std::span<const std::byte> coded, uint64_t vertices, uint32_t size,
                                       const std::string& where) {
    const uint64_t flagBytes = smallestVisibilityChunk(vertices, size);
    if (coded.size() < flagBytes)
        throw Error(fmt::format("{}: expected at least {} bytes, found {}; the file is damaged", where,
                                flagBytes, coded.size()));
    Bytes bytes(flagBytes);
    std::memcpy(bytes.data(), coded.data(), flagBytes);
    coded = coded.subspan(flagBytes);
    for (int level = 0; level < kLevels; level++) bytes = spread(bytes, coded, where);
    if (!coded.empty())
        throw Error(fmt::format("{}: {} bytes are left over behind the last bits; the file is damaged", where,
                                coded.size()));

    std::vector<uint32_t> bits(bytes.size() / sizeof(uint32_t));
    std::memcpy(bits.data(), bytes.data(), bytes.size());
    const size_t rowWords = size / 32, vertexWords = 6 * size * rowWords;
    for (size_t vertex = 0; vertex < bits.size(); vertex += vertexWords)
        for (size_t word = vertex + rowWords; word < vertex + vertexWords; word++)
            bits[word] ^= bits[word - rowWords];
    return bits;
}

} // namespace relume

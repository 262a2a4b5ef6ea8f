// Decodes values of 16 bits from OpenEXR's canonical Huffman coding. The library has two decoders, ImfHuf.cpp
// and ImfFastHuf.cpp, which differ where no encoder leads: what they would read differently, or slowly, is
// refused.
#include "engine/import/exr_check.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

// Reads bits, the most significant first.
class BitReader {
  public:
    BitReader(Bytes bytes, uint64_t bits)
        : mBytes(bytes), mLeft(std::min<uint64_t>(bits, 8 * bytes.size())) {}

    bool isEmpty() const { return mLeft == 0; }
    size_t bytesRead() const { return (mPlace + 7) / 8; }

    // Returns a number of 8 bits at most, or nothing where so many are not left.
    std::optional<uint32_t> take(int count) {
        if (mLeft < uint64_t(count)) return std::nullopt;
        uint32_t number = 0;
        for (int i = 0; i < count; i++, mPlace++)
            number = number << 1 | (std::to_integer<uint32_t>(mBytes[mPlace / 8]) >> (7 - mPlace % 8) & 1);
        mLeft -= uint64_t(count);
        return number;
    }

  private:
    Bytes mBytes;
    uint64_t mPlace = 0, mLeft;
};

// A prefix code that is given by the lengths of its codes. Of each length the codes count up from the first
// one in the order of their symbols, and shorter codes are above longer ones.
class CanonicalCode {
  public:
    static constexpr size_t kLongest = 52; // bits, which the library's double precision holds

    void add(uint32_t symbol, size_t length) {
        mSymbols[length].push_back(symbol);
        mCount++;
    }

    size_t count() const { return mCount; }

    // Returns whether the code is complete: whether any bits are those of symbols.
    bool finish() {
        uint64_t code = 0;
        for (size_t length = kLongest; length > 0; length--) {
            mFirst[length] = code;
            code += mSymbols[length].size();
            if (code % 2 != 0) return false;
            code /= 2;
        }
        return code == 1;
    }

    std::optional<uint32_t> decode(BitReader& bits) const {
        uint64_t code = 0;
        for (size_t length = 1; length <= kLongest; length++) {
            const std::optional<uint32_t> bit = bits.take(1);
            if (!bit) break;
            code = code << 1 | *bit;
            if (code >= mFirst[length] && code - mFirst[length] < mSymbols[length].size())
                return mSymbols[length][size_t(code - mFirst[length])];
        }
        return std::nullopt;
    }

  private:
    std::array<std::vector<uint32_t>, kLongest + 1> mSymbols; // by length
    std::array<uint64_t, kLongest + 1> mFirst{};
    size_t mCount = 0;
};

// Reads the lengths of the codes of the symbols from `first` to `last`, in 6 bits each; 59 to 62 stand for 2
// to 5 symbols without a code, 63 for 6 more than the next 8 bits say.
std::optional<CanonicalCode> readCode(BitReader& bits, uint32_t first, uint32_t last) {
    CanonicalCode code;
    for (uint32_t symbol = first; symbol <= last;) {
        const std::optional<uint32_t> length = bits.take(6);
        if (!length) return std::nullopt;
        if (*length <= 58) {
            if (*length > CanonicalCode::kLongest) return std::nullopt;
            if (*length > 0) code.add(symbol, *length);
            symbol++;
        } else {
            uint32_t absent = *length - 57;
            if (*length == 63) {
                const std::optional<uint32_t> more = bits.take(8);
                if (!more) return std::nullopt;
                absent = 6 + *more;
            }
            symbol += absent;
            if (symbol > last + 1) return std::nullopt;
        }
    }
    if (!code.finish()) return std::nullopt;
    return code;
}

} // namespace

bool decodeExrHuffman(Bytes packed, uint64_t count, const std::function<void(uint16_t)>& take) {
    constexpr uint32_t kMostSymbols = (1 << 16) + 1; // all values, and one that repeats
    std::array<uint32_t, 5> numbers; // first and last symbol, bytes of the code, bits of the values, nothing
    if (packed.size() < sizeof numbers) return false;
    std::memcpy(numbers.data(), packed.data(), sizeof numbers);
    const auto [first, last, codeBytes, valueBits, nothing] = numbers;
    if (last >= kMostSymbols) return false;
    const Bytes rest = packed.subspan(sizeof numbers);
    BitReader codeReader(rest, 8 * rest.size());
    const std::optional<CanonicalCode> code = readCode(codeReader, first, last);
    // Every symbol with a code occurs, but for the one that repeats. For many that do not, the library would
    // take quadratic time.
    if (!code || code->count() > size_t(valueBits) + 1) return false;
    BitReader bits(rest.subspan(codeReader.bytesRead()), valueBits);
    uint64_t taken = 0;
    for (std::optional<uint32_t> symbol, previous; !bits.isEmpty();) {
        symbol = code->decode(bits);
        uint32_t repeats = 1;
        if (symbol == last) { // the value before, as often as 8 bits say
            const std::optional<uint32_t> times = bits.take(8);
            if (!times || *times == 0) return false;
            repeats = *times;
            symbol = previous;
        }
        if (!symbol || repeats > count - taken) return false;
        for (uint32_t i = 0; i < repeats; i++) take(uint16_t(*symbol));
        taken += repeats;
        previous = symbol;
    }
    return taken == count;
}

} // namespace relume

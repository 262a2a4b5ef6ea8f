// Writing and reading of little-endian numbers, the same on every machine.
#pragma once

#include "engine/base/error.h"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <fmt/core.h>
#include <span>
#include <string_view>
#include <vector>

namespace relume {

// Appends numbers and bytes to a vector of bytes.
class ByteWriter {
  public:
    template <std::unsigned_integral T>
    void put(T value) {
        for (size_t plane = 0; plane < sizeof(T); plane++) mBytes.push_back(std::byte(value >> 8 * plane));
    }

    void put(std::span<const std::byte> bytes) { mBytes.insert(mBytes.end(), bytes.begin(), bytes.end()); }

    // Appends all lowest bytes, all second bytes and so on: those of equal significance compress best
    // together.
    template <std::unsigned_integral T>
    void putPlanes(std::span<const T> values) {
        const size_t start = mBytes.size(), count = values.size();
        mBytes.resize(start + sizeof(T) * count);
        for (size_t plane = 0; plane < sizeof(T); plane++) {
            std::byte* out = mBytes.data() + start + plane * count;
            for (size_t i = 0; i < count; i++) out[i] = std::byte(values[i] >> 8 * plane);
        }
    }

    const std::vector<std::byte>& bytes() const { return mBytes; }
    std::vector<std::byte> take() { return std::move(mBytes); }

  private:
    std::vector<std::byte> mBytes;
};

// Reads what ByteWriter wrote. Reading beyond the end throws Error. `where` names the data in that error; the
// reader keeps a reference to it and to `bytes`, which must outlive the reader.
class ByteReader {
  public:
    ByteReader(std::span<const std::byte> bytes, std::string_view where) : mRest(bytes), mWhere(where) {}

    std::span<const std::byte> take(size_t count) {
        if (count > mRest.size())
            throw Error(fmt::format("{}: expected {} more bytes, found {}; the file is damaged", mWhere,
                                    count, mRest.size()));
        const auto taken = mRest.first(count);
        mRest = mRest.subspan(count);
        return taken;
    }

    template <std::unsigned_integral T>
    T get() {
        const auto bytes = take(sizeof(T));
        T value = 0;
        for (size_t plane = 0; plane < sizeof(T); plane++) value = T(value | T(bytes[plane]) << 8 * plane);
        return value;
    }

    template <std::unsigned_integral T>
    std::vector<T> getPlanes(size_t count) {
        const std::byte* in = take(sizeof(T) * count).data(); // callers bound `count`: no overflow
        std::vector<T> values(count);
        for (size_t plane = 0; plane < sizeof(T); plane++)
            for (size_t i = 0; i < count; i++)
                values[i] = T(values[i] | T(in[plane * count + i]) << 8 * plane);
        return values;
    }

    size_t left() const { return mRest.size(); }

  private:
    std::span<const std::byte> mRest;
    std::string_view mWhere;
};

} // namespace relume

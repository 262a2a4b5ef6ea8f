// Content hashes: XXH3, 128 bits for provenance, 64 bits for checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace relume {

// 64-bit checksum of the bytes.
uint64_t hash64(std::span<const std::byte> bytes);

// 128-bit content hash of the bytes, as 32 hexadecimal digits.
std::string hashText(std::span<const std::byte> bytes);

// The same of bytes that come piece by piece.
class Hasher {
  public:
    Hasher();
    ~Hasher();
    void add(std::span<const std::byte> bytes);
    std::string text() const;

  private:
    struct State;
    std::unique_ptr<State> mState;
};

} // namespace relume

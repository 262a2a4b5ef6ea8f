// Content hashes by XXH3: 128 bits for provenance, 64 bits for checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace relume {

// Returns a 64-bit checksum.
uint64_t hash64(std::span<const std::byte> bytes);

// Returns a 128-bit content hash as 32 hexadecimal digits.
std::string hashText(std::span<const std::byte> bytes);

// Computes the hash of hashText() from bytes that are added piece by piece.
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

// Random numbers that depend on what they are for, not on when they are drawn.
#pragma once

#include <cstdint>

namespace relume {

// The same stream for the same pixel and pass, whatever else was drawn.
class HashedNumbers {
  public:
    HashedNumbers(uint32_t pixel, uint32_t pass) : mCounter(mix(uint64_t(pass) << 32 | pixel)) {}

    // Uniform in [0, 1), of 24 bits.
    float next() { return float(mix(mCounter += 0x9e3779b97f4a7c15u) >> 40) * 0x1p-24f; }

  private:
    // The finaliser of SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators",
    // OOPSLA 2014; constants: Stafford's variant 13).
    static uint64_t mix(uint64_t z) {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }

    uint64_t mCounter;
};

} // namespace relume

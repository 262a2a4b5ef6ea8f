// Random numbers that depend on their purpose, not on the order in which they are drawn.
#pragma once

#include <cstdint>

namespace relume {

// A stream of random numbers that depends on pixel and pass alone.
class HashedNumbers {
  public:
    HashedNumbers(uint32_t pixel, uint32_t pass) : mCounter(mix(uint64_t(pass) << 32 | pixel)) {}

    // Returns the next number, uniform in [0, 1), with 24 random bits.
    float next() { return float(mix(mCounter += 0x9e3779b97f4a7c15u) >> 40) * 0x1p-24f; }

  private:
    // The finalizer of SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators",
    // OOPSLA 2014; constants: Stafford's variant 13).
    static uint64_t mix(uint64_t z) {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }

    uint64_t mCounter;
};

} // namespace relume

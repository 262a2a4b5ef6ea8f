// What fuzzing and the tests call: a reader behind a function of bytes, and inputs to begin with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace relume::test {

using Bytes = std::vector<std::byte>;

struct FuzzTarget {
    const char* name;
    // Reads an input, whatever it is. Aborts, or throws, on a finding: Errors that refuse it are caught.
    void (*run)(std::span<const std::byte> input);
    std::vector<Bytes> (*seeds)(); // valid inputs, made by the project's own writers where there are some
    // What it may hold at a time: so much, and so much for each byte of input.
    uint64_t mostBytes = uint64_t(64) << 20, mostBytesPerByte = 64;
    int mutations = 200; // of each seed in the tests
};

// Every target of the program, by name.
const std::vector<FuzzTarget>& fuzzTargets();

// Adds a target, before main().
struct AddFuzzTarget {
    explicit AddFuzzTarget(const FuzzTarget& target);
};

// Bytes of a text behind others that choose how it is read.
inline Bytes seedOf(std::initializer_list<int> choices, std::string_view text) {
    Bytes seed;
    for (const int choice : choices) seed.push_back(std::byte(choice));
    const auto bytes = std::as_bytes(std::span(text));
    seed.insert(seed.end(), bytes.begin(), bytes.end());
    return seed;
}

inline Bytes seedOf(std::initializer_list<int> choices, std::span<const std::byte> bytes) {
    return seedOf(choices, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

inline std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace relume::test

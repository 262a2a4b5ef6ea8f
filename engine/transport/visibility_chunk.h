// Coding of the visibility bits of a block of vertices as bytes that compress well: the visb chunks of
// docs/asset_format.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace relume {

constexpr uint32_t kSmallestKeptVisibility = 64; // least side of a face that the coding supports

// Return the largest and smallest number of bytes that encodeVisibility() makes of `vertices` vertices, for
// cubes of 6 · size² texels. The smallest is a 512th of the bits' bytes.
uint64_t largestVisibilityChunk(uint64_t vertices, uint32_t size);
uint64_t smallestVisibilityChunk(uint64_t vertices, uint32_t size);

// Encodes the bits of whole vertices, 6 · size² each, in the order of Visibility::record(); `size` is a
// multiple of 64.
std::vector<std::byte> encodeVisibility(std::span<const uint32_t> bits, uint32_t size);

// Decodes the bits of `vertices` vertices. Throws Error, in which `where` names the chunk, unless `coded`
// holds exactly these.
std::vector<uint32_t> decodeVisibility(std::span<const std::byte> coded, uint64_t vertices, uint32_t size,
                                       const std::string& where);

} // namespace relume

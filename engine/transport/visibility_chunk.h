// Visibility bits of a block of vertices as bytes that compress well: the visb chunks of
// docs/asset_format.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace relume {

constexpr uint32_t kSmallestKeptVisibility = 64; // side of a face: what the coding's levels need

// Most bytes that encodeVisibility() makes of `vertices` vertices, for cubes of 6 · size² texels; the least
// is a 512th of their bits, in bytes.
uint64_t largestVisibilityChunk(uint64_t vertices, uint32_t size);
uint64_t smallestVisibilityChunk(uint64_t vertices, uint32_t size);

// `bits`: whole vertices, 6 · size² bits each, as Visibility::record() gives them; `size` a multiple of 64.
std::vector<std::byte> encodeVisibility(std::span<const uint32_t> bits, uint32_t size);

// The bits of `vertices` vertices, which must be all that `coded` holds. `where` names the chunk in errors.
// Throws Error.
std::vector<uint32_t> decodeVisibility(std::span<const std::byte> coded, uint64_t vertices, uint32_t size,
                                       const std::string& where);

} // namespace relume

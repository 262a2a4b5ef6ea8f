// Hashes of what determines the bytes of a bake.
#pragma once

#include "engine/base/hash.h"
#include "engine/transport/asset.h"
#include "precompute/visibility/visibility.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace relume {

// A hash of a sequence of arrays and texts. Includes the length of each array and text, so that boundaries
// matter.
class ContentHash {
  public:
    template <typename Element>
    void add(std::span<Element> elements) {
        static_assert(std::is_trivially_copyable_v<Element>);
        const uint64_t bytes = elements.size_bytes();
        mHasher.add(std::as_bytes(std::span(&bytes, 1)));
        mHasher.add(std::as_bytes(elements));
    }
    void add(std::string_view text) { add(std::span(text.data(), text.size())); }

    std::string text() const { return mHasher.text(); }

  private:
    Hasher mHasher;
};

// Returns a hash of everything that determines visibility bits, so that equal keys mean equal bits: the
// XXH3-128, as 32 hexadecimal digits, of the method and its kernels' SPIR-V, device and driver, the cube's
// size, the visibility offset, the occluder, and every part's positions and normals.
std::string visibilityKey(const Asset& asset, VisibilityMethod method);

} // namespace relume

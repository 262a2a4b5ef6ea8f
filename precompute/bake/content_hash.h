// A hash of a sequence of arrays and texts.
#pragma once

#include "engine/base/hash.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace relume {

// Includes the length of each array and text, so that boundaries matter.
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

} // namespace relume

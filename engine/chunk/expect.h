// Checks of data that throw Error if a condition does not hold.
#pragma once

#include "engine/base/error.h"

#include <cmath>
#include <fmt/format.h>
#include <string>

namespace relume {

inline void expect(bool holds, const std::string& where, const char* what) {
    if (!holds) throw Error(fmt::format("{}: expected {}", where, what));
}

inline void expectCount(size_t count, size_t expected, const std::string& where, const char* what) {
    if (count != expected)
        throw Error(fmt::format("{}: expected {} {}, found {}", where, expected, what, count));
}

inline bool isMagnitude(float value) { return std::isfinite(value) && value >= 0; }

} // namespace relume

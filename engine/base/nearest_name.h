// "Did you mean …?" for unknown keys and names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relume {

// The one of `names` (not empty) with the smallest edit distance (Levenshtein 1966) to `name`; the first
// of equals.
std::string_view nearestName(std::string_view name, std::span<const std::string_view> names);

} // namespace relume

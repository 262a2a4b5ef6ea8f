// "Did you mean …?" for unknown keys and names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relume {

// Returns the element of `names` (not empty) with the smallest edit distance to `name` (Levenshtein 1966);
// the first one if several are equally near.
std::string_view nearestName(std::string_view name, std::span<const std::string_view> names);

} // namespace relume

// Numbers that belong together, told by their ends.
#pragma once

#include <string>
#include <vector>

namespace relume {

// "0.84 to 1.2" of the least and the largest in three digits, or one number where these are the same; "-" of
// none.
std::string rangeText(const std::vector<double>& values);

} // namespace relume

#include "apps/evaluation/range_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

// Never 1.23e+03.
std::string threeDigits(double value) {
    return std::abs(value) >= 999.5 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

} // namespace

std::string rangeText(const std::vector<double>& values) {
    if (values.empty()) return "-";
    const auto [least, most] = std::ranges::minmax(values);
    const std::string low = threeDigits(least), high = threeDigits(most);
    return low == high ? low : low + " to " + high;
}

} // namespace relume

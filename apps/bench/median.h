// The median, which benchmarks print.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relume {

// Returns the median of at least one value; of two middle values the upper.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace relume

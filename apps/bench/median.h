// The statistic that benchmarks print.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relume {

// Of at least one value; the upper of two middle ones.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace relume

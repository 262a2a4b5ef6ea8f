// Times work for benchmarks, and summarizes the times.
#pragma once

#include "engine/base/stopwatch.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace relume {

// Returns the wall-clock milliseconds that `work` takes.
template <typename Work>
double milliseconds(const Work& work) {
    const Stopwatch watch;
    work();
    return 1e3 * watch.seconds();
}

// Returns the median of at least one value; of two middle values the upper.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Returns the median ratio of two series' times in the same rounds.
inline double medianRatio(std::vector<double> values, const std::vector<double>& divisors) {
    for (size_t i = 0; i < values.size(); i++) values[i] /= divisors[i];
    return median(std::move(values));
}

} // namespace relume

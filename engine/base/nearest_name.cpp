#include "engine/base/nearest_name.h"

#include "engine/base/check.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace relume {
namespace {

size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); j++) row[j] = j;
    for (size_t i = 1; i <= a.size(); i++) {
        size_t diagonal = std::exchange(row[0], i);
        for (size_t j = 1; j <= b.size(); j++) {
            const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string_view nearestName(std::string_view name, std::span<const std::string_view> names) {
    RELUME_CHECK(!names.empty());
    // Truncate: beyond the length of any name all distances rank alike, and the text may be hostile and huge.
    const std::string_view start = name.substr(0, 64);
    return *std::min_element(names.begin(), names.end(), [&](std::string_view a, std::string_view b) {
        return editDistance(start, a) < editDistance(start, b);
    });
}

} // namespace relume

#include "precompute/transport/row_packing.h"

#include "engine/base/check.h"
#include "engine/transport/rows/sparse_transport.h"

#include <algorithm>
#include <bit>
#include <functional>

namespace relume {

std::vector<uint16_t> indicesOfLargest(const std::vector<vec3>& coefficients, int count) {
    constexpr uint64_t kLastIndex = 0xffff;
    RELUME_CHECK(count >= 0);
    RELUME_CHECK_LE(coefficients.size(), kLastIndex + 1);
    // Positive floats order like their bits; for equal ones the lower index ranks higher.
    std::vector<uint64_t> ranks;
    for (size_t i = 0; i < coefficients.size(); i++) {
        const vec3& c = coefficients[i];
        const float energy = c.x * c.x + c.y * c.y + c.z * c.z; // in the kernel's order of operations
        if (energy > 0) ranks.push_back(uint64_t(std::bit_cast<uint32_t>(energy)) << 16 | (kLastIndex - i));
    }
    if (ranks.size() > size_t(count)) {
        std::nth_element(ranks.begin(), ranks.begin() + count, ranks.end(), std::greater());
        ranks.resize(size_t(count));
    }
    std::vector<uint16_t> kept;
    for (const uint64_t rank : ranks) kept.push_back(uint16_t(kLastIndex - (rank & kLastIndex)));
    std::sort(kept.begin(), kept.end());
    return kept;
}

PackedRow packLargest(const std::vector<vec3>& coefficients, int count) {
    const std::vector<uint16_t> kept = indicesOfLargest(coefficients, count);
    PackedRow row;
    for (const uint16_t index : kept) {
        const vec3 magnitude = glm::abs(coefficients[index]);
        row.scale = std::max({row.scale, magnitude.x, magnitude.y, magnitude.z});
    }
    for (const uint16_t index : kept) {
        const ivec3 quantized = quantizeCoefficient(coefficients[index], row.scale);
        if (quantized == ivec3(0)) continue;
        row.indices.push_back(index);
        row.values.push_back(packCoefficient(quantized));
    }
    return row;
}

} // namespace relume

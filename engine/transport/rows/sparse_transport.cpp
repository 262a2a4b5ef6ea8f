#include "engine/transport/rows/sparse_transport.h"

#include "engine/chunk/block_chunk.h"

#include <algorithm>
#include <cmath>

namespace relume {

static bool isWithinMaxima(uint32_t packed) {
    // Only a field's most negative number lies beyond the negated maximum.
    const ivec3 value = unpackCoefficient(packed);
    return value.x >= -kRedMaximum && value.y >= -kGreenMaximum && value.z >= -kBlueMaximum;
}

uint64_t SparseTransport::bytes() const {
    return scales.size() * sizeof(float) + indices.size() * sizeof(uint16_t) +
           values.size() * sizeof(uint32_t);
}

void SparseTransport::dequantizeRow(size_t row, std::span<vec3> coefficients) const {
    const vec3 unit = scales[row] * kCoefficientUnit;
    for (uint64_t entry = rowStarts[row]; entry < rowStarts[row + 1]; entry++)
        coefficients[indices[entry]] = vec3(unpackCoefficient(values[entry])) * unit;
}

void checkTransport(const SparseTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where) {
    expectCount(transport.rowStarts.size(), transport.rows() + 1, where, "row starts");
    expectCount(transport.scales.size(), transport.rows(), where, "scales");
    expectCount(transport.indices.size(), transport.entries(), where, "indices");
    expect(transport.rowStarts.front() == 0 && transport.rowStarts.back() == transport.entries(), where,
           "rows that span all entries");
    expect(std::ranges::all_of(transport.scales, isMagnitude), where,
           "scales that are finite and not negative");
    for (size_t row = 0; row < transport.rows(); row++) {
        const uint64_t start = transport.rowStarts[row], end = transport.rowStarts[row + 1];
        if (end < start || end - start > longestRow || end > transport.entries())
            throw Error(fmt::format("{}: row {}: expected at most {} entries, found entries {} to {}", where,
                                    row, longestRow, start, end));
        checkIndices(std::span(transport.indices).subspan(start, end - start), coefficients,
                     [&] { return fmt::format("{}: row {}", where, row); });
    }
    expect(std::ranges::all_of(transport.values, isWithinMaxima), where,
           "values within ±1023 in red and green and ±511 in blue");
}

ivec3 quantizeCoefficient(vec3 value, float scale) {
    if (!(scale > 0)) return ivec3(0);
    const auto quantize = [&](float component, int maximum) {
        const float steps = component / scale * float(maximum);
        return int(steps < 0 ? std::ceil(steps - 0.5f) : std::floor(steps + 0.5f));
    };
    return {quantize(value.x, kRedMaximum), quantize(value.y, kGreenMaximum),
            quantize(value.z, kBlueMaximum)};
}

} // namespace relume

#include "precompute/transport/row_sum.h"

#include "engine/base/check.h"

#include <algorithm>

namespace relume {

RowSum::RowSum(size_t coefficients) : mSums(coefficients, vec3(0)), mTouched((coefficients + 63) / 64) {}

PackedRow RowSum::pack(int kept, Energies* energies) {
    std::vector<uint16_t> indices; // ascending, so that ties are broken as among all coefficients
    std::vector<vec3> values;
    drain([&](size_t coefficient, vec3 value) {
        indices.push_back(uint16_t(coefficient));
        values.push_back(value);
    });
    PackedRow row = packLargest(values, kept);
    if (energies) {
        *energies = {};
        double keptEnergy = 0;
        for (const vec3& value : values) energies->total += double(glm::dot(value, value));
        for (size_t i = 0; i < row.indices.size(); i++) {
            const vec3 value = values[row.indices[i]],
                       lost = value - row.scale * kCoefficientUnit * vec3(unpackCoefficient(row.values[i]));
            keptEnergy += double(glm::dot(value, value));
            energies->quantized += double(glm::dot(lost, lost));
        }
        energies->dropped = std::max(0.0, energies->total - keptEnergy);
    }
    for (uint16_t& index : row.indices) index = indices[index];
    return row;
}

SparseTransport emptyRows(uint32_t terms) { return {0, terms, {0}, {}, {}, {}}; }

double energyOf(const SparseTransport& rows, size_t row) {
    double sum = 0;
    for (uint64_t entry = rows.rowStarts[row]; entry < rows.rowStarts[row + 1]; entry++) {
        const vec3 value = rows.scales[row] * kCoefficientUnit * vec3(unpackCoefficient(rows.values[entry]));
        sum += double(glm::dot(value, value));
    }
    return sum;
}

void appendRow(SparseTransport& rows, const PackedRow& row) {
    rows.indices.insert(rows.indices.end(), row.indices.begin(), row.indices.end());
    rows.values.insert(rows.values.end(), row.values.begin(), row.values.end());
    rows.scales.push_back(row.scale);
    rows.rowStarts.push_back(rows.entries());
}

void appendRows(SparseTransport& rows, const SparseTransport& more) {
    RELUME_CHECK_EQ(rows.terms, more.terms);
    const auto join = [](auto& values, const auto& others) {
        values.insert(values.end(), others.begin(), others.end());
    };
    const uint64_t before = rows.entries();
    for (size_t row = 0; row < more.rows(); row++) rows.rowStarts.push_back(before + more.rowStarts[row + 1]);
    join(rows.scales, more.scales);
    join(rows.indices, more.indices);
    join(rows.values, more.values);
    rows.vertices += more.vertices;
}

} // namespace relume

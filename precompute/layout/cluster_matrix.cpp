#include "precompute/layout/cluster_matrix.h"

#include "precompute/layout/basis_kinds.h"
#include "precompute/layout/unit_sum.h"

#include <algorithm>

namespace relume {

namespace {

// Calls entry(row of the matrix, kind, coefficient, value) for all that a cluster holds.
template <typename Entry>
void forEachEntry(const SparseTransport& rows, uint32_t first, uint32_t count,
                  std::span<const BasisKind> kinds, std::span<const float> spectrum, float unit,
                  const Entry& entry) {
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const vec3 dual = kindDual(kinds[kind]) * glm::length(kinds[kind].color);
        for (uint32_t vertex = 0; vertex < count; vertex++) {
            const size_t row = (size_t(first) + vertex) * rows.terms + kinds[kind].term;
            const vec3 scale = dual * (rows.scales[row] / unit) * kCoefficientUnit;
            for (uint64_t i = rows.rowStarts[row]; i < rows.rowStarts[row + 1]; i++)
                entry(kind * count + vertex, kind, rows.indices[i],
                      glm::dot(scale, vec3(unpackCoefficient(rows.values[i]))) * spectrum[rows.indices[i]]);
        }
    }
}

} // namespace

float transportUnit(const SparseTransport& rows, std::span<const float> spectrum) {
    UnitSum sum(rows.terms, spectrum);
    sum.add(rows);
    return sum.unit();
}

ClusterMatrix clusterMatrix(const SparseTransport& rows, uint32_t first, uint32_t count,
                            std::span<const BasisKind> kinds, std::span<const float> spectrum, float unit) {
    ClusterMatrix matrix;
    matrix.vertices = count;
    matrix.unit = unit;
    if (rows.terms == 1) matrix.importance = kDiffuseImportance;
    matrix.energy.setZero(Eigen::Index(kinds.size()));
    std::vector<double> energy(spectrum.size(), 0.0);
    forEachEntry(rows, first, count, kinds, spectrum, unit,
                 [&](size_t, size_t kind, uint16_t column, float value) {
                     const double square = double(value) * value;
                     matrix.energy[Eigen::Index(kind)] += square;
                     energy[column] += square;
                 });

    for (size_t column = 0; column < energy.size(); column++)
        if (energy[column] > 0) matrix.columns.push_back(uint16_t(column));
    const size_t most = kinds.size() * count <= kAnalysedSide ? kMostBasisColumns : kAnalysedSide;
    if (matrix.columns.size() > most) {
        std::nth_element(
            matrix.columns.begin(), matrix.columns.begin() + ptrdiff_t(most), matrix.columns.end(),
            [&](uint16_t a, uint16_t b) { return energy[a] != energy[b] ? energy[a] > energy[b] : a < b; });
        matrix.columns.resize(most);
        std::ranges::sort(matrix.columns);
    }

    std::vector<int> places(spectrum.size(), -1);
    for (size_t i = 0; i < matrix.columns.size(); i++) places[matrix.columns[i]] = int(i);
    matrix.values.setZero(Eigen::Index(kinds.size() * count), Eigen::Index(matrix.columns.size()));
    forEachEntry(rows, first, count, kinds, spectrum, unit,
                 [&](size_t row, size_t, uint16_t column, float value) {
                     if (places[column] >= 0) matrix.values(Eigen::Index(row), places[column]) = value;
                 });
    return matrix;
}

} // namespace relume

#include "precompute/layout/cluster_encoder.h"

#include "engine/base/check.h"
#include "engine/transport/cluster_chunk.h"

#include <algorithm>

namespace relume {

namespace {

struct Column {
    uint32_t term;
    uint16_t index;
    float energy;
};

// All columns of a cluster, by term and index.
std::vector<Column> columnsOf(const SparseTransport& rows, size_t cluster, std::span<const float> spectrum,
                              float unit) {
    const auto first = uint32_t(cluster * kClusterVertices);
    const uint32_t end = std::min(rows.vertices, first + kClusterVertices);
    std::vector<Column> columns;
    std::vector<double> energy(spectrum.size(), 0.0);
    for (uint32_t term = 0; term < rows.terms; term++) {
        std::ranges::fill(energy, 0.0);
        for (uint32_t vertex = first; vertex < end; vertex++) {
            const size_t row = size_t(vertex) * rows.terms + term;
            const vec3 scale = rows.scales[row] / unit * kCoefficientUnit;
            for (uint64_t i = rows.rowStarts[row]; i < rows.rowStarts[row + 1]; i++) {
                const vec3 value =
                    vec3(unpackCoefficient(rows.values[i])) * scale * spectrum[rows.indices[i]];
                energy[rows.indices[i]] += double(glm::dot(value, value));
            }
        }
        for (size_t index = 0; index < energy.size(); index++)
            if (energy[index] > 0) columns.push_back({term, uint16_t(index), float(energy[index])});
    }
    return columns;
}

} // namespace

std::vector<float> columnEnergies(const SparseTransport& rows, size_t cluster,
                                  std::span<const float> spectrum, float unit) {
    std::vector<float> energies;
    for (const Column& column : columnsOf(rows, cluster, spectrum, unit)) energies.push_back(column.energy);
    return energies;
}

KeptColumns keepColumns(const SparseTransport& rows, size_t cluster, std::span<const float> spectrum,
                        float unit, float threshold) {
    KeptColumns result;
    std::vector<Column> columns = columnsOf(rows, cluster, spectrum, unit), kept;
    const auto isStronger = [](const Column& a, const Column& b) { return a.energy > b.energy; };
    std::ranges::stable_sort(columns, isStronger);
    for (const Column& column : columns)
        if (column.energy >= threshold && kept.size() < kMostClusterColumns)
            kept.push_back(column);
        else
            result.error += double(column.energy);
    std::ranges::sort(kept, [](const Column& a, const Column& b) {
        return a.term != b.term ? a.term < b.term : a.index < b.index;
    });

    ClusteredTransport& transport = result.transport;
    const auto first = uint32_t(cluster * kClusterVertices);
    transport.vertices = std::min(rows.vertices - first, kClusterVertices);
    transport.terms = rows.terms;
    // A row keeps the scale that it has: what stays is then exact.
    const size_t firstRow = size_t(first) * rows.terms;
    transport.scales.assign(rows.scales.begin() + ptrdiff_t(firstRow),
                            rows.scales.begin() + ptrdiff_t(firstRow + transport.rows()));
    transport.columnStarts.push_back(0);
    auto column = kept.begin();
    for (uint32_t term = 0; term < rows.terms; term++) {
        for (; column != kept.end() && column->term == term; column++)
            transport.indices.push_back(column->index);
        transport.columnStarts.push_back(transport.indices.size());
    }
    transport.values.assign(kept.size() * kClusterVertices, 0);
    for (size_t number = 0; number < kept.size(); number++)
        for (uint32_t vertex = 0; vertex < transport.vertices; vertex++) {
            const size_t row = firstRow + size_t(vertex) * rows.terms + kept[number].term;
            const auto begin = rows.indices.begin() + ptrdiff_t(rows.rowStarts[row]);
            const auto end = rows.indices.begin() + ptrdiff_t(rows.rowStarts[row + 1]);
            const auto found = std::lower_bound(begin, end, kept[number].index);
            if (found != end && *found == kept[number].index)
                transport.values[number * kClusterVertices + vertex] =
                    rows.values[size_t(found - rows.indices.begin())];
        }
    return result;
}

void append(ClusteredTransport& all, const ClusteredTransport& more) {
    RELUME_CHECK(all.terms == more.terms && all.vertices % kClusterVertices == 0);
    const auto join = [](auto& values, const auto& others) {
        values.insert(values.end(), others.begin(), others.end());
    };
    if (all.columnStarts.empty()) all.columnStarts.push_back(0);
    const uint64_t before = all.columns();
    for (size_t group = 0; group < more.groups(); group++)
        all.columnStarts.push_back(before + more.columnStarts[group + 1]);
    join(all.scales, more.scales);
    join(all.indices, more.indices);
    join(all.values, more.values);
    all.vertices += more.vertices;
}

} // namespace relume

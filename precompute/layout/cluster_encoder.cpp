#include "precompute/layout/cluster_encoder.h"

#include "engine/transport/cluster_chunk.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

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

struct ClusterColumns {
    std::vector<Column> kept;
    std::vector<float> scales;    // per row
    std::vector<uint32_t> values; // kClusterVertices per column
    double error = 0;
};

void pack(const SparseTransport& rows, size_t cluster, ClusterColumns& columns) {
    const auto first = uint32_t(cluster * kClusterVertices);
    const uint32_t count = std::min(rows.vertices - first, kClusterVertices);
    // A row keeps the scale that it has: what stays is then exact.
    columns.scales.assign(rows.scales.begin() + ptrdiff_t(size_t(first) * rows.terms),
                          rows.scales.begin() + ptrdiff_t(size_t(first + count) * rows.terms));
    columns.values.assign(columns.kept.size() * kClusterVertices, 0);
    for (size_t column = 0; column < columns.kept.size(); column++)
        for (uint32_t vertex = 0; vertex < count; vertex++) {
            const size_t row = size_t(first + vertex) * rows.terms + columns.kept[column].term;
            const auto begin = rows.indices.begin() + ptrdiff_t(rows.rowStarts[row]);
            const auto end = rows.indices.begin() + ptrdiff_t(rows.rowStarts[row + 1]);
            const auto found = std::lower_bound(begin, end, columns.kept[column].index);
            if (found != end && *found == columns.kept[column].index)
                columns.values[column * kClusterVertices + vertex] =
                    rows.values[size_t(found - rows.indices.begin())];
        }
}

} // namespace

std::vector<float> columnEnergies(const SparseTransport& rows, std::span<const float> spectrum, float unit) {
    const size_t clusters = (size_t(rows.vertices) + kClusterVertices - 1) / kClusterVertices;
    std::vector<std::vector<float>> each(clusters);
    tbb::parallel_for(size_t(0), clusters, [&](size_t cluster) {
        for (const Column& column : columnsOf(rows, cluster, spectrum, unit))
            each[cluster].push_back(column.energy);
    });
    std::vector<float> energies;
    for (const auto& own : each) energies.insert(energies.end(), own.begin(), own.end());
    return energies;
}

EncodedClusters encodeClusters(const SparseTransport& rows, std::span<const float> spectrum, float unit,
                               float threshold) {
    EncodedClusters encoded;
    ClusteredTransport& transport = encoded.transport;
    transport.vertices = rows.vertices;
    transport.terms = rows.terms;
    std::vector<ClusterColumns> clusters(transport.clusters());
    tbb::parallel_for(size_t(0), clusters.size(), [&](size_t number) {
        ClusterColumns& cluster = clusters[number];
        std::vector<Column> columns = columnsOf(rows, number, spectrum, unit);
        const auto isStronger = [](const Column& a, const Column& b) { return a.energy > b.energy; };
        std::ranges::stable_sort(columns, isStronger);
        for (const Column& column : columns)
            if (column.energy >= threshold && cluster.kept.size() < kMostClusterColumns)
                cluster.kept.push_back(column);
            else
                cluster.error += double(column.energy);
        std::ranges::sort(cluster.kept, [](const Column& a, const Column& b) {
            return a.term != b.term ? a.term < b.term : a.index < b.index;
        });
        pack(rows, number, cluster);
    });
    transport.columnStarts.push_back(0);
    for (const ClusterColumns& cluster : clusters) {
        auto column = cluster.kept.begin();
        for (uint32_t term = 0; term < rows.terms; term++) {
            for (; column != cluster.kept.end() && column->term == term; column++)
                transport.indices.push_back(column->index);
            transport.columnStarts.push_back(transport.indices.size());
        }
        transport.scales.insert(transport.scales.end(), cluster.scales.begin(), cluster.scales.end());
        transport.values.insert(transport.values.end(), cluster.values.begin(), cluster.values.end());
        encoded.error += cluster.error;
    }
    return encoded;
}

} // namespace relume

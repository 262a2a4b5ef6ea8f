// Transport in which the vertices of a cluster share their coefficient sets, kept as columns without an index
// per entry.
#pragma once

#include "engine/math/vector.h"

#include <vector>

namespace relume {

constexpr uint32_t kClusterVertices = 32; // neighbours in bake order; the last cluster may have fewer

// Group g = cluster · terms + term has columns [columnStarts[g], columnStarts[g + 1]). Column c is
// coefficient `indices[c]` of the cluster's vertices: values[c · kClusterVertices + i] is vertex i's, packed
// and scaled as an entry of SparseTransport, zero for vertices that a last cluster lacks.
struct ClusteredTransport {
    uint32_t vertices = 0;
    uint32_t terms = 0;
    std::vector<uint64_t> columnStarts; // groups + 1
    std::vector<float> scales;          // per row = vertex · terms + term
    std::vector<uint16_t> indices;      // per column: face·F² + y·F + x, rising within a group
    std::vector<uint32_t> values;       // kClusterVertices per column

    size_t rows() const { return size_t(vertices) * terms; }
    size_t clusters() const { return (size_t(vertices) + kClusterVertices - 1) / kClusterVertices; }
    size_t groups() const { return clusters() * terms; }
    size_t columns() const { return indices.size(); }
};

} // namespace relume

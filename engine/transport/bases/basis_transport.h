// Transport in bases: each cluster of vertices has a few basis vectors, which all its vertices, terms and
// channels share, and weights for them.
#pragma once

#include "engine/math/vector.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace relume {

constexpr uint32_t kBasisVertices = 256;       // per cluster, neighbors in bake order
constexpr uint32_t kMostBasisColumns = 4096;   // per cluster
constexpr uint32_t kMostBasisComponents = 256; // per cluster: basis vectors
constexpr int kBasisMaximum = 127;             // largest magnitude of basis values and weights

// One direction in the color space of a term's transport. Most of a material's transport lies along one
// direction; for a gray material all of it lies along (1, 1, 1). A term has at most three; without any it is
// zero.
struct BasisKind {
    uint32_t term = 0;
    vec3 color{1};
};

// The transport of one cluster. With R components, coefficient `indices[c]` of a vertex v of the cluster is,
// for a term, the sum over the kinds j of that term of
//
//     kinds[j].color · Σ_i  scales[s_j + i] · weights[w_j + v · counts[j] + i] · basis[c · R + i]
//
// for i < counts[j], and zero for indices that no column has. s_j and w_j are where the scales and weights of
// kind j begin.
struct BasisCluster {
    uint32_t components = 0;       // R
    std::vector<uint16_t> indices; // per column: face·F² + y·F + x, rising
    std::vector<int8_t> basis;     // column after column, R each
    std::vector<uint16_t> counts;  // per kind: it has weights for the first so many components
    std::vector<float> scales;     // kind after kind, per component
    std::vector<int8_t> weights;   // kind after kind, vertex after vertex

    size_t columns() const { return indices.size(); }
};

// A set's transport in bases.
struct BasisTransport {
    static constexpr const char* kName = "bases";
    static constexpr std::array<char, 4> kTag = {'T', 'R', 'B', 'S'};

    uint32_t vertices = 0;
    uint32_t terms = 0;
    std::vector<BasisKind> kinds;       // by rising term
    std::vector<BasisCluster> clusters; // each of kBasisVertices vertices; the last may have fewer

    size_t rows() const { return size_t(vertices) * terms; }
    size_t clusterCount() const { return (size_t(vertices) + kBasisVertices - 1) / kBasisVertices; }
    uint32_t verticesOf(size_t cluster) const {
        const auto left = uint32_t(vertices - cluster * kBasisVertices);
        return left < kBasisVertices ? left : kBasisVertices;
    }
    size_t entries() const; // columns of all clusters
    uint64_t bytes() const;
    // Dequantizes a row to `coefficients`, which must be zero before.
    void dequantizeRow(size_t row, std::span<vec3> coefficients) const;
};

// Checks the kinds. Throws Error.
void checkLayout(const BasisTransport& layout, const std::string& where);

// Checks one cluster of `vertices` vertices. Throws Error.
void checkCluster(const BasisCluster& cluster, size_t vertices, size_t kinds, uint32_t coefficients,
                  const std::string& where);

// Checks all clusters and the kinds. Throws Error. Ignores the third parameter: rows may have any length.
void checkTransport(const BasisTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where);

} // namespace relume

// Transport of clusters of vertices as a few basis vectors each, which all vertices, terms and channels of
// the cluster share, and weights.
#pragma once

#include "engine/math/vector.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace relume {

constexpr uint32_t kBasisVertices = 256;       // of a cluster, neighbors in bake order
constexpr uint32_t kMostBasisColumns = 4096;   // of a cluster
constexpr uint32_t kMostBasisComponents = 256; // of a cluster
constexpr int kBasisMaximum = 127;             // magnitude of basis values and weights

// One direction in the color space of a term's transport. Most of a material's transport lies along one: of
// a gray one all, along (1, 1, 1). A term has at most three; without any it is zero.
struct BasisKind {
    uint32_t term = 0;
    vec3 color{1};
};

// With R components, coefficient `indices[c]` of a vertex v of the cluster is, in the term of kind j and to
// be summed over that term's kinds,
//
//     kinds[j].color · Σ_i  scales[s_j + i] · weights[w_j + v · counts[j] + i] · basis[c · R + i],   i <
//     counts[j]
//
// and zero where no column has that index; s_j and w_j follow those of the kinds before.
struct BasisCluster {
    uint32_t components = 0;       // R
    std::vector<uint16_t> indices; // per column: face·F² + y·F + x, rising
    std::vector<int8_t> basis;     // column after column, R each
    std::vector<uint16_t> counts;  // per kind: it has weights for the first so many components
    std::vector<float> scales;     // kind after kind, per component
    std::vector<int8_t> weights;   // kind after kind, vertex after vertex

    size_t columns() const { return indices.size(); }
};

struct BasisTransport {
    static constexpr const char* kName = "bases";
    static constexpr std::array<char, 4> kTag = {'T', 'R', 'B', 'S'};

    uint32_t vertices = 0;
    uint32_t terms = 0;
    std::vector<BasisKind> kinds;       // by rising term
    std::vector<BasisCluster> clusters; // all of kBasisVertices vertices, but the last may have fewer

    size_t rows() const { return size_t(vertices) * terms; }
    size_t clusterCount() const { return (size_t(vertices) + kBasisVertices - 1) / kBasisVertices; }
    uint32_t verticesOf(size_t cluster) const {
        const auto left = uint32_t(vertices - cluster * kBasisVertices);
        return left < kBasisVertices ? left : kBasisVertices;
    }
    size_t entries() const; // columns of all clusters
    uint64_t bytes() const;
    void addCoefficients(size_t row, std::span<vec3> coefficients) const;
};

// The kinds: what the weights of all clusters are amounts of. Throws Error.
void checkLayout(const BasisTransport& layout, const std::string& where);

// One cluster of so many vertices. Throws Error.
void checkCluster(const BasisCluster& cluster, size_t vertices, size_t kinds, uint32_t coefficients,
                  const std::string& where);

// All of them, and the kinds; rows of bases may be of any length. Throws Error.
void checkTransport(const BasisTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where);

} // namespace relume

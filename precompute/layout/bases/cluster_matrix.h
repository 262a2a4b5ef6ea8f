// The transport of a cluster of vertices as one matrix, for compression: amounts of a few directions in
// color space, the kinds, along which a material's transport lies.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/bases/basis_transport.h"
#include "engine/transport/rows/sparse_transport.h"

#include <Eigen/Core>
#include <span>

namespace relume {

// Returns, per term, the principal directions of its light map, an orthonormal set by falling energy, but for
// those with less than 1e-7 of the term's; for a map whose channels are equal, (1, 1, 1) alone. Bounced light
// has colors of its own: `isBounced` gives all three directions.
std::vector<BasisKind> basisKinds(const FactoredBrdf& brdf, bool isBounced = false);

// The amount of a kind in coefficient `t` is dot(kindDual(kind), t).
inline vec3 kindDual(const BasisKind& kind) { return kind.color / glm::dot(kind.color, kind.color); }

// Errors of it are errors of relighting: amounts of kinds times the length of their color, and times the
// light's spectrum (light_spectrum.h), in units of `unit`. Row j · vertices + v is kind j of vertex v.
struct ClusterMatrix {
    uint32_t vertices = 0;
    float unit = 1;
    double importance = 1;         // of its squared error, when bytes are shared out
    std::vector<uint16_t> columns; // coefficients, rising: those of most energy
    Eigen::MatrixXf values;
    Eigen::VectorXd energy; // per kind, over all coefficients: sums of squares

    size_t kinds() const { return size_t(energy.size()); }
};

// The shorter side of a matrix that is analyzed, at most: time grows with its square. Few kinds leave room
// for all the columns that a file can have, which the sharp shadows on a ground need; of many kinds more
// columns win little.
constexpr size_t kAnalysedSide = 512;

// A set of one term is diffuse, most often a ground: shadows are all that is seen on it, and no highlight
// hides what storage loses of them. Their squared errors count this many times.
constexpr double kDiffuseImportance = 40;

// Returns the matrix of vertices [first, first + count) of a set's rows.
ClusterMatrix clusterMatrix(const SparseTransport& rows, uint32_t first, uint32_t count,
                            std::span<const BasisKind> kinds, std::span<const float> spectrum, float unit);

} // namespace relume

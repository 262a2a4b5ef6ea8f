// The transport of a cluster of vertices as one matrix, for compression.
#pragma once

#include "engine/transport/basis_transport.h"
#include "engine/transport/sparse_transport.h"

#include <Eigen/Core>
#include <span>

namespace relume {

// Errors of it are errors of relighting: amounts of kinds times the length of their colour, and times the
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

// Root mean square over a set's vertices of how far they are from their mean in all terms, times the
// spectrum; a tenth of what they hold at least; 1 for none. As the unit it makes errors relative to what
// tells vertices apart: a dark part is not starved beside a bright one, nor a shadow on a ground that is
// otherwise even.
float transportUnit(const SparseTransport& rows, std::span<const float> spectrum);

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

// Principal components of a cluster's transport, and rate–distortion optimal truncation of them.
#pragma once

#include "precompute/layout/bases/cluster_matrix.h"

namespace relume {

// Components of the first vector, which needs more precision than a byte, or clusters' borders show on smooth
// surfaces: the second component refines its values, the third its weights.
constexpr uint32_t kFirstComponents = 3;

// Principal components of a ClusterMatrix. Component 0 and components kFirstComponents and up each have a
// vector.
struct BasisAnalysis {
    uint32_t vertices = 0;
    std::vector<uint16_t> columns;
    Eigen::MatrixXf vectors;      // columns × vectors, orthonormal
    Eigen::MatrixXd vectorEnergy; // kinds × vectors: energy of the matrix along each
    Eigen::VectorXd energy;       // per kind, of the whole matrix
    double importance = 1;        // of the matrix
    double weight = 1;            // number of clusters that it stands for

    uint32_t components() const;
};

// Computes the principal components of a cluster.
BasisAnalysis analyze(const ClusterMatrix& matrix);

// A truncated basis. `columns` are indices into the analysis's columns.
struct BasisCut {
    uint32_t components = 0;
    std::vector<uint32_t> columns;
    std::vector<uint16_t> counts; // per kind: number of components
    double bytes = 0;             // in memory
    double error = 0;             // squared, without quantization
};

// Returns the cut that minimizes importance · error + lambda · bytes.
BasisCut cutFor(const BasisAnalysis& analysis, double lambda);

// Totals over all clusters. All are cut with one Lagrange multiplier, lambda, which gives the least total
// error for the bytes (Shoham and Gersho 1988). Clusters count with their weight.
struct CutTotals {
    double bytes = 0;
    double error = 0; // squared, relative to the matrices' normalization; without quantization
};

// Returns the totals of all clusters' cuts at a lambda: the error that a byte must save.
CutTotals totalsAt(std::span<const BasisAnalysis> clusters, double lambda);

// Returns the lambda at which all cuts take `bytes`, or as many below as possible.
double lambdaForBytes(std::span<const BasisAnalysis> clusters, double bytes);

// Returns the highest lambda at which the squared error is at most `error`. If there is none, the last bytes
// buy next to nothing: returns the highest lambda at which it exceeds the least error by at most a tenth of
// `error`.
double lambdaForError(std::span<const BasisAnalysis> clusters, double error);

} // namespace relume

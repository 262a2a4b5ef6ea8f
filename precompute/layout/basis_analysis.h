// What a cluster's transport can be cut down to, and the price of each cut.
#pragma once

#include "precompute/layout/cluster_matrix.h"

namespace relume {

// The first vector is kept more exactly than a byte is, or smooth surfaces show the clusters' borders: as
// three components, with a second byte for its values and one for its weights.
constexpr uint32_t kFirstComponents = 3;

// Principal components of a ClusterMatrix. The vectors are those of components 0 and kFirstComponents and up.
struct BasisAnalysis {
    uint32_t vertices = 0;
    std::vector<uint16_t> columns;
    Eigen::MatrixXf vectors;      // columns × vectors, orthonormal
    Eigen::MatrixXd vectorEnergy; // kinds × vectors: of the matrix along each
    Eigen::VectorXd energy;       // per kind, of the whole matrix
    double importance = 1;        // the matrix's
    double weight = 1;            // how many clusters it stands for

    uint32_t components() const;
};

BasisAnalysis analyse(const ClusterMatrix& matrix);

// A cut. `columns` are numbers of the analysis's.
struct BasisCut {
    uint32_t components = 0;
    std::vector<uint32_t> columns;
    std::vector<uint16_t> counts; // per kind
    double bytes = 0;             // in memory
    double error = 0;             // squared, but for quantisation
};

// The cut of least importance · error + price · bytes.
BasisCut cutFor(const BasisAnalysis& analysis, double price);

} // namespace relume

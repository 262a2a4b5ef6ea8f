// What a cluster's transport can be cut down to, and what a byte of it is worth.
#pragma once

#include "precompute/layout/bases/cluster_matrix.h"

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

BasisAnalysis analyze(const ClusterMatrix& matrix);

// A cut. `columns` are numbers of the analysis's.
struct BasisCut {
    uint32_t components = 0;
    std::vector<uint32_t> columns;
    std::vector<uint16_t> counts; // per kind
    double bytes = 0;             // in memory
    double error = 0;             // squared, but for quantization
};

// The cut of least importance · error + price · bytes.
BasisCut cutFor(const BasisAnalysis& analysis, double price);

// Clusters are cut at one slope of error against bytes, their price, which gives the whole the least error
// for its bytes (Shoham and Gersho 1988). A cluster's weight is how many it stands for.
struct CutTotals {
    double bytes = 0;
    double error = 0; // squared, in units of the matrices, but for quantization
};

// Of all clusters' cuts at a price: an error that a byte must save.
CutTotals totalsAt(std::span<const BasisAnalysis> clusters, double price);

// The price at which all cuts together have `bytes`, or the most below.
double priceForBytes(std::span<const BasisAnalysis> clusters, double bytes);

// The highest price at which the squared error is at most `error`; else what leaves the least.
double priceForError(std::span<const BasisAnalysis> clusters, double error);

} // namespace relume

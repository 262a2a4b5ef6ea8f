// A cluster's transport as quantised basis vectors and weights.
#pragma once

#include "precompute/layout/basis_analysis.h"

namespace relume {

struct EncodedCluster {
    BasisCluster cluster;
    double error = 0; // squared, of the matrix: the cut's and quantisation's
};

// `kinds` and `spectrum` are those that the matrix was made with.
EncodedCluster encodeBases(const ClusterMatrix& matrix, const BasisAnalysis& analysis, const BasisCut& cut,
                           std::span<const BasisKind> kinds, std::span<const float> spectrum);

} // namespace relume

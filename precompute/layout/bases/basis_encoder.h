// Encodes transport as quantized basis vectors and weights, by cluster or for a whole asset.
#pragma once

#include "precompute/layout/bases/basis_analysis.h"
#include "precompute/transport/layout_work.h"

namespace relume {

struct EncodedCluster {
    BasisCluster cluster;
    double error = 0; // squared, of the matrix: by truncation and quantization
};

// Encodes a cut. `kinds` and `spectrum` are those from which the matrix was made.
EncodedCluster encodeBases(const ClusterMatrix& matrix, const BasisAnalysis& analysis, const BasisCut& cut,
                           std::span<const BasisKind> kinds, std::span<const float> spectrum);

// The functions that layouts.h requires of a layout.
void prepareLayout(BasisTransport& layout, const FactoredBrdf& brdf, bool isBounced);
EncodedBlock encodeBlock(const BasisTransport& layout, const SparseTransport& rows,
                         const BlockCoding& coding);
double findLambda(const BasisTransport& layout, std::span<const SetSample> samples, int faceSize,
                  const LayoutTarget& target);
double convertRows(const BasisTransport& layout, const RowSource& source, const LayoutTarget& target,
                   ConversionPasses& passes);

} // namespace relume

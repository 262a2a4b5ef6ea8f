// The peer of `relume bench relight`: rows as sparse matrices of a well-kept library.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/rows/sparse_transport.h"

#include <Eigen/SparseCore>
#include <array>

namespace relume {

// A compressed-sparse-row matrix of floats per channel, times the light's coefficients, on all cores.
class CsrRelighter {
  public:
    CsrRelighter(const SparseTransport& transport, int faceSize);

    // The tuples, channel by channel, but for rounding.
    void relight(const LightVector& light, std::array<Eigen::VectorXf, 3>& tuples) const;

  private:
    using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor, int>;
    std::array<Matrix, 3> mChannels;
};

} // namespace relume

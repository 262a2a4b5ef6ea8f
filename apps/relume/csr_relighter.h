// Relighting of rows with a sparse-matrix library, Eigen, for comparison in `relume bench relight`.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/rows/sparse_transport.h"

#include <Eigen/SparseCore>
#include <array>

namespace relume {

// Multiplies a compressed-sparse-row float matrix per channel by the light's entries, on all cores.
class CsrRelighter {
  public:
    CsrRelighter(const SparseTransport& transport, int faceSize);

    // Computes the tuples per channel, equal to relight() up to rounding.
    void relight(const LightVector& light, std::array<Eigen::VectorXf, 3>& tuples) const;

  private:
    using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor, int>;
    std::array<Matrix, 3> mChannels;
};

} // namespace relume

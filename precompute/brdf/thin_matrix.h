// Products of a large matrix and one of a few columns.
#pragma once

#include <Eigen/Core>

namespace relume {

// A matrix of as few columns as a BRDF has terms. It is stored row by row, and filled up with columns of
// zeros to a multiple of kThinLanes, so that a row is a whole number of vectors.
using ThinMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr Eigen::Index kThinLanes = 8;

// Returns a copy of `matrix` that is filled up with columns of zeros.
ThinMatrix thinned(const Eigen::MatrixXf& matrix);

// Eigen's general product copies the large factor into panels, which here takes longer than to multiply.
// These read it once per kThinLanes columns of the thin one. `large` is some columns of a matrix. The order
// of summation, and so every bit, depends on the sizes alone.

// Sets `product`, a row per column of `large`, to largeᵀ · thin.
void multiplyTransposed(const Eigen::Ref<const Eigen::MatrixXf>& large, const ThinMatrix& thin,
                        Eigen::Ref<ThinMatrix> product);

// Adds large · thin to `product`.
void addProduct(const Eigen::Ref<const Eigen::MatrixXf>& large, const Eigen::Ref<const ThinMatrix>& thin,
                ThinMatrix& product);

} // namespace relume

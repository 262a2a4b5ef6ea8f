// Eigen's singular values, compiled once for all tests that need them.
#pragma once

#include <Eigen/Core>

namespace relume::test {

// Returns the singular values of a matrix, the largest first.
Eigen::VectorXf singularValues(const Eigen::MatrixXf& matrix);

} // namespace relume::test

// The first eigenvectors of a covariance.
#pragma once

#include <Eigen/Core>

namespace relume {

struct LeadingEigenvectors {
    Eigen::VectorXf values;  // falling
    Eigen::MatrixXf vectors; // one a column, orthonormal
};

// Of a positive semidefinite matrix, its lower triangle: the `count` (at most all) largest that are more than
// rounding. By subspace iteration where that is less work, good to what transport needs: the sum of the
// values is within about 1 % of the best in what it leaves.
LeadingEigenvectors leadingEigenvectors(const Eigen::MatrixXf& lower, Eigen::Index count);

} // namespace relume

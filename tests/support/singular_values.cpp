#include "tests/support/singular_values.h"

#include <Eigen/SVD>

namespace relume::test {

Eigen::VectorXf singularValues(const Eigen::MatrixXf& matrix) {
    return Eigen::BDCSVD<Eigen::MatrixXf>(matrix).singularValues();
}

} // namespace relume::test

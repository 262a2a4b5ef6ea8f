// Products of large and thin matrices against Eigen's own.
#include "precompute/brdf/thin_matrix.h"

#include <doctest/doctest.h>

using namespace relume;
using Eigen::Index;
using Eigen::MatrixXf;

TEST_CASE("thin matrix: products are Eigen's, of any number of rows, columns and terms") {
    for (const Index rows : {1, 7, 64, 301})
        for (const Index columns : {1, 8, 13, 100})
            for (const Index terms : {1, 8, 9, 32}) {
                CAPTURE(rows);
                CAPTURE(columns);
                CAPTURE(terms);
                const MatrixXf all = MatrixXf::Random(rows, columns + 3);
                const auto large = all.middleCols(2, columns);
                const MatrixXf left = MatrixXf::Random(rows, terms), right = MatrixXf::Random(columns, terms);
                ThinMatrix transposed(columns, thinned(left).cols());
                multiplyTransposed(large, thinned(left), transposed);
                CHECK((transposed.leftCols(terms) - large.transpose() * left).cwiseAbs().maxCoeff() < 1e-4f);
                CHECK_EQ(transposed.rightCols(transposed.cols() - terms).cwiseAbs().sum(), 0.0f);
                ThinMatrix sum = ThinMatrix::Ones(rows, thinned(right).cols());
                addProduct(large, thinned(right), sum);
                CHECK(((sum.leftCols(terms).array() - 1).matrix() - large * right).cwiseAbs().maxCoeff() <
                      1e-4f);
            }
}

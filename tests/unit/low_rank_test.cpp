// Tests low-rank factorizations against Eigen's full decompositions, and nonnegative ones.
#include "precompute/brdf/low_rank.h"
#include "precompute/brdf/tabulation.h"
#include "tests/support/singular_values.h"

#include <doctest/doctest.h>
#include <random>

using namespace relume;
using namespace relume::test;
using Eigen::Index;
using Eigen::MatrixXf;

namespace {

MatrixXf randomMatrix(Index rows, Index columns, uint32_t seed) {
    std::mt19937 random(seed);
    return MatrixXf::NullaryExpr(rows, columns, [&] { return float(random() >> 8) * 0x1p-24f; });
}

MatrixXf sideBySide(const std::vector<MatrixXf>& blocks) {
    MatrixXf all(blocks[0].rows(), 0);
    for (const MatrixXf& block : blocks) {
        const Index columns = all.cols();
        all.conservativeResize(Eigen::NoChange, columns + block.cols());
        all.rightCols(block.cols()) = block;
    }
    return all;
}

MatrixXf productOf(const LowRank& factors) {
    std::vector<MatrixXf> blocks;
    for (const MatrixXf& right : factors.right)
        blocks.push_back(factors.left * factors.values.asDiagonal() * right.transpose());
    return sideBySide(blocks);
}

void checkAgainstSvd(const std::vector<MatrixXf>& blocks, int terms) {
    const LowRank factors = lowRank(blocks, terms);
    const MatrixXf all = sideBySide(blocks);
    const Eigen::VectorXf values = singularValues(all);
    REQUIRE(factors.right.size() == blocks.size());
    for (int k = 0; k < terms; k++)
        CHECK(factors.values[k] == doctest::Approx(values[k]).epsilon(1e-4).scale(values[0]));
    const MatrixXf identity = MatrixXf::Identity(terms, terms);
    CHECK((factors.left.transpose() * factors.left - identity).cwiseAbs().maxCoeff() < 1e-4f);
    MatrixXf gram = MatrixXf::Zero(terms, terms);
    for (const MatrixXf& right : factors.right) gram += right.transpose() * right;
    CHECK((gram - identity).cwiseAbs().maxCoeff() < 1e-4f);
    // No product of as many factors is nearer (Eckart and Young 1936).
    const float rest = values.tail(values.size() - terms).norm();
    CHECK((productOf(factors) - all).norm() == doctest::Approx(rest).epsilon(1e-3));
}

// A glossy BRDF's red channel, times the cosines.
MatrixXf brdfMatrix(const char* material) {
    BrdfTable table = tabulate(*makeBrdf(material), 16, DiskMapping::EqualArea, TexelValue::Mean);
    Eigen::VectorXf cosines(table.channels[0].rows());
    for (size_t i = 0; i < table.directions.size(); i++) cosines[Index(i)] = table.directions[i].z;
    return cosines.asDiagonal() * table.channels[0] * cosines.asDiagonal();
}

} // namespace

TEST_CASE("low rank: one block, wide, tall and square, agrees with Eigen's singular values") {
    checkAgainstSvd({randomMatrix(30, 30, 1)}, 6);
    checkAgainstSvd({randomMatrix(20, 50, 2)}, 6);
    checkAgainstSvd({randomMatrix(50, 20, 3)}, 6);
    checkAgainstSvd({brdfMatrix("gold")}, 12);
}

TEST_CASE("low rank: several blocks agree with Eigen's singular values of all side by side") {
    checkAgainstSvd({randomMatrix(30, 30, 1), randomMatrix(30, 12, 2), 3 * randomMatrix(30, 40, 3)}, 8);
    checkAgainstSvd({brdfMatrix("gold"), brdfMatrix("clay"), brdfMatrix("gray-diffuse")}, 12);
}

TEST_CASE("low rank: non-negative factors lose little, and more of them lose less") {
    const std::vector<MatrixXf> blocks = {brdfMatrix("ashikhmin-shirley"), brdfMatrix("clay")};
    const MatrixXf all = sideBySide(blocks);
    float last = all.norm();
    for (const int terms : {1, 2, 4, 8, 16}) {
        CAPTURE(terms);
        const LowRank factors = nonNegativeLowRank(blocks, terms);
        CHECK(factors.left.minCoeff() >= 0);
        for (const MatrixXf& right : factors.right) CHECK(right.minCoeff() >= 0);
        for (int k = 1; k < terms; k++) CHECK(factors.values[k] <= factors.values[k - 1]);
        const float error = (productOf(factors) - all).norm(),
                    least = (productOf(lowRank(blocks, terms)) - all).norm();
        CHECK(error < last);
        CHECK(error >= 0.999f * least);
        CHECK(error <= 1.2f * least);
        last = error;
    }
}

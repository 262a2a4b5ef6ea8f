// Tests the block eigensolver against constructed spectra, Eigen and Spectra.
#include "precompute/brdf/eigenpairs.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/tabulation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Spectra/SymEigsSolver.h>
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using namespace relume;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

namespace {

MatrixXd randomOrthogonal(int n) {
    std::srand(5); // Eigen's Random
    return Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(n, n)).householderQ();
}

// Q diag(values, small values) Qᵀ
MatrixXd withSpectrum(const std::vector<double>& values, int n) {
    VectorXd diagonal(n);
    for (int i = 0; i < n; i++)
        diagonal[i] = size_t(i) < values.size() ? values[size_t(i)] : 0.5 * std::cos(double(i));
    const MatrixXd q = randomOrthogonal(n);
    return q * diagonal.asDiagonal() * q.transpose();
}

void checkOrthonormal(const MatrixXf& vectors) {
    const MatrixXf gram = vectors.transpose() * vectors;
    CHECK((gram - MatrixXf::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff() < 1e-5f);
}

// Every pair of the block solver against the library's full decomposition: the values one by one, the
// vectors by how much of them lies in the library's invariant subspace of nearly the same value.
void checkAgainstEigen(const MatrixXd& matrix, int count) {
    const Eigenpairs pairs = largestEigenpairs(MatrixXf(matrix.cast<float>()), count);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> library(matrix);
    std::vector<double> sizes(library.eigenvalues().begin(), library.eigenvalues().end());
    for (double& value : sizes) value = std::abs(value);
    std::sort(sizes.rbegin(), sizes.rend());

    checkOrthonormal(pairs.vectors);
    for (int k = 0; k < count; k++) {
        const double value = double(pairs.values[k]);
        const VectorXd vector = pairs.vectors.col(k).cast<double>();
        CHECK(std::abs(value) == doctest::Approx(sizes[size_t(k)]).epsilon(1e-4));
        CHECK((matrix * vector - value * vector).norm() < 2e-5 * sizes[0]);
        double inside = 0;
        for (int j = 0; j < matrix.rows(); j++)
            if (std::abs(library.eigenvalues()[j] - value) < 2e-3 * sizes[0])
                inside += std::pow(library.eigenvectors().col(j).dot(vector), 2);
        CHECK(inside > 1 - 1e-3);
    }
}

} // namespace

TEST_CASE("eigenpairs: ± pairs, near ± pairs and multiple values converge") {
    checkAgainstEigen(withSpectrum({5, -5, 4, 4, 4, -4, 3, -3.000015, 2, 2, -2, -2}, 150), 12);
    checkAgainstEigen(withSpectrum({1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1}, 60), 4);
}

TEST_CASE("eigenpairs: as many as the matrix has, identity, zero, and one by one") {
    checkAgainstEigen(withSpectrum({3, -2, 1}, 12), 12);
    for (int n = 1; n <= 40; n++) checkAgainstEigen(withSpectrum({2, -2}, n), n);
    const Eigenpairs identity = largestEigenpairs(MatrixXf::Identity(50, 50), 8);
    for (float value : identity.values) CHECK(value == doctest::Approx(1));
    checkOrthonormal(identity.vectors);
    const Eigenpairs zero = largestEigenpairs(MatrixXf::Zero(50, 50), 3);
    CHECK(zero.values.isZero());
    checkOrthonormal(zero.vectors);
    const Eigenpairs one = largestEigenpairs(MatrixXf::Constant(1, 1, -7), 1);
    CHECK(one.values[0] == doctest::Approx(-7));
    CHECK(one.vectors(0, 0) == doctest::Approx(1));
}

TEST_CASE("eigenpairs: the component of largest magnitude is positive") {
    const Eigenpairs pairs = largestEigenpairs(MatrixXf(withSpectrum({5, -4, 3}, 40).cast<float>()), 3);
    for (int k = 0; k < 3; k++) {
        const auto vector = pairs.vectors.col(k);
        CHECK(vector.maxCoeff() >= 0.999f * vector.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("eigenpairs: of BRDFs agree with Eigen's full decomposition") {
    for (const char* material : {"ashikhmin-shirley", "skin", "red-plastic"})
        for (DiskMapping mapping :
             {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar, DiskMapping::Polar}) {
            CAPTURE(material);
            const BrdfTable table = tabulate(*makeBrdf(material), 16, mapping);
            const MatrixXd matrix = table.channels[0].cast<double>();
            checkAgainstEigen((matrix + matrix.transpose()) / 2, 32);
        }
    const BrdfTable table = tabulate(*makeBrdf("ashikhmin-shirley"), 24, DiskMapping::Orthographic);
    const MatrixXd matrix = table.channels[0].cast<double>();
    checkAgainstEigen((matrix + matrix.transpose()) / 2, 32);
}

TEST_CASE("eigenpairs: a cluster larger than what is wanted of it converges") {
    std::vector<double> values;
    for (int i = 0; i < 24; i++) {
        values.push_back(5 - 1e-5 * i);
        values.push_back(-5 + 2e-5 * i);
    }
    const MatrixXf matrix = withSpectrum(values, 400).cast<float>();
    const Eigenpairs pairs = largestEigenpairs(matrix, 4);
    for (int k = 0; k < 4; k++) {
        CHECK(std::abs(pairs.values[k]) == doctest::Approx(5).epsilon(1e-5));
        CHECK((matrix * pairs.vectors.col(k) - pairs.values[k] * pairs.vectors.col(k)).norm() < 6e-5f);
    }
}

TEST_CASE("eigenpairs: of Ashikhmin-Shirley, clay and skin at 48 x 48 agree with Spectra") {
    constexpr int kCount = 16;
    for (const char* material : {"ashikhmin-shirley", "clay", "skin"}) {
        CAPTURE(material);
        const BrdfTable table = tabulate(*makeBrdf(material), 48, DiskMapping::Orthographic);
        const FactoredBrdf factored = factorize(table, {kCount, Factorization::Paper});
        REQUIRE(factored.terms == kCount);
        const bool isGray = table.channels[0] == table.channels[2];
        for (size_t c = 0; c < (isGray ? 1 : 3); c++) {
            const MatrixXd exact = (table.channels[c] + table.channels[c].transpose()).cast<double>() / 2;
            Spectra::DenseSymMatProd<double> product(exact);
            Spectra::SymEigsSolver<Spectra::DenseSymMatProd<double>> library(product, kCount + 4, 80);
            library.init();
            const auto order = Spectra::SortRule::LargestMagn;
            REQUIRE(library.compute(order, 1000, 1e-10, order) == kCount + 4);
            const VectorXd values = library.eigenvalues();
            for (int k = 0; k < kCount; k++) {
                const double value = double(factored.eigenvalues[size_t(k)][c]);
                CHECK(std::abs(value) == doctest::Approx(std::abs(values[k])).epsilon(1e-4));
                // Signs too: pairs of nearly ±λ may come in either order.
                CHECK((values.array() - value).abs().minCoeff() < 1e-4 * std::abs(value));
            }
        }
    }
}

TEST_CASE("eigenpairs: those of Ashikhmin-Shirley at 48 x 48 stay what they were") {
    const BrdfTable table = tabulate(*makeBrdf("ashikhmin-shirley"), 48, DiskMapping::Orthographic);
    const FactoredBrdf factored = factorize(table, {4, Factorization::Paper});
    constexpr double kValues[] = {390.6, -311.3, 296.9, -281.1};
    for (size_t k = 0; k < 4; k++)
        CHECK(factored.eigenvalues[k][0] == doctest::Approx(kValues[k]).epsilon(1e-3));
}

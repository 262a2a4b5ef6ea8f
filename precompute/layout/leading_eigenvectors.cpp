#include "precompute/layout/leading_eigenvectors.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <random>

namespace relume {

namespace {

constexpr Eigen::Index kSpare = 16; // more vectors than wanted let those converge
constexpr int kIterations = 4;
constexpr float kLeastValue = 1e-7f; // of the largest

Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& vectors) {
    return Eigen::HouseholderQR<Eigen::MatrixXf>(vectors).householderQ() *
           Eigen::MatrixXf::Identity(vectors.rows(), vectors.cols());
}

} // namespace

LeadingEigenvectors leadingEigenvectors(const Eigen::MatrixXf& lower, Eigen::Index count) {
    const Eigen::Index size = lower.rows();
    Eigen::MatrixXf subspace;
    Eigen::MatrixXf reduced = lower;
    const bool isPartial = 3 * (count + kSpare) < size;
    if (isPartial) {
        const auto matrix = lower.selfadjointView<Eigen::Lower>();
        std::mt19937 random; // the same start each time
        subspace =
            Eigen::MatrixXf::NullaryExpr(size, count + kSpare, [&] { return random() & 1 ? 1.0f : -1.0f; });
        for (int i = 0; i < kIterations; i++) subspace = orthonormal(matrix * subspace);
        reduced = subspace.transpose() * (matrix * subspace);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(reduced);
    LeadingEigenvectors leading;
    leading.values = solver.eigenvalues().reverse();
    Eigen::Index kept = 0;
    while (kept < std::min(count, leading.values.size()) &&
           leading.values[kept] > kLeastValue * leading.values[0])
        kept++;
    leading.values.conservativeResize(kept);
    leading.vectors = solver.eigenvectors().rightCols(kept).rowwise().reverse();
    if (isPartial) leading.vectors = subspace * leading.vectors;
    return leading;
}

} // namespace relume

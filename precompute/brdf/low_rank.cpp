#include "precompute/brdf/low_rank.h"

#include "engine/base/check.h"
#include "precompute/brdf/eigenpairs.h"

#include <Eigen/Eigenvalues>

namespace relume {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

namespace {

// Tolerance of the iteration's eigenpairs. Their errors enter the result squared, so this suffices.
constexpr float kEigenpairTolerance = 1e-5f;

float inverseOrZero(double value) { return value > 0 ? float(1 / value) : 0; }

} // namespace

LowRank lowRank(std::span<const MatrixXf> blocks, int terms) {
    const Index n = blocks[0].rows();
    // The left singular vectors of [B₀ | B₁ | …] are eigenvectors of Σ Bⱼ Bⱼᵀ.
    const auto apply = [&](const MatrixXf& vectors) -> MatrixXf {
        MatrixXf sum = MatrixXf::Zero(n, vectors.cols());
        for (const MatrixXf& block : blocks) sum.noalias() += block * (block.transpose() * vectors).eval();
        return sum;
    };
    const Eigenpairs pairs = largestEigenpairs(apply, int(n), terms, kEigenpairTolerance);

    // Squaring halved the precision of small values, but the products Bᵀu still have it. A final
    // Rayleigh–Ritz step on their Gram matrix, in double precision, gives values and vectors to float
    // rounding.
    LowRank result;
    MatrixXd gram = MatrixXd::Zero(terms, terms);
    for (const MatrixXf& block : blocks) {
        result.right.push_back(block.transpose() * pairs.vectors);
        const MatrixXd product = result.right.back().cast<double>();
        gram.noalias() += product.transpose() * product;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(gram);
    const VectorXd values = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
    const MatrixXf rotation = solver.eigenvectors().rowwise().reverse().cast<float>();
    result.values = values.cast<float>();
    result.left = pairs.vectors * rotation;
    for (MatrixXf& right : result.right) {
        right = (right * rotation).eval();
        for (Index k = 0; k < terms; k++) right.col(k) *= inverseOrZero(values[k]);
    }
    return result;
}

} // namespace relume

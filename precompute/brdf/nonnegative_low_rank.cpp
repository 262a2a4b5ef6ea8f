#include "precompute/brdf/low_rank.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tbb/parallel_for.h>

namespace relume {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;

namespace {

// Least singular value that counts towards the rank, relative to the largest.
constexpr float kLeastValue = 1e-5f;
constexpr int kSweeps = 60; // over the last twenty the error falls by less than a thousandth

using Blocks = std::vector<MatrixXf>;

double squaredNorm(const Blocks& blocks, Index column) {
    double sum = 0;
    for (const MatrixXf& block : blocks) sum += double(block.col(column).squaredNorm());
    return sum;
}

// Initializes a term by the positive or negative part of a singular pair, whichever product is larger. Zeros
// would stay zero, so they become small values.
void startFromHalf(LowRank& start, Index k) {
    const auto half = [](const auto& vector, float sign) { return (sign * vector).cwiseMax(0.0f).eval(); };
    const auto size = [&](float sign) {
        double right = 0;
        for (const MatrixXf& block : start.right) right += double(half(block.col(k), sign).squaredNorm());
        return double(half(start.left.col(k), sign).squaredNorm()) * right;
    };
    const float sign = size(1) >= size(-1) ? 1.0f : -1.0f;
    const auto replace = [&](auto&& vector) {
        vector = half(vector, sign);
        vector = vector.cwiseMax(0.01f * vector.mean()).eval();
    };
    replace(start.left.col(k));
    for (MatrixXf& block : start.right) replace(block.col(k));
    start.left.col(k) *= start.values[k];
}

// Sweeps over the columns of `factor`, making each the least-squares optimum for `target` ≈ factor · otherᵀ,
// given product = target · other and gram = otherᵀ · other.
void sweep(MatrixXf& factor, const MatrixXf& product, const MatrixXf& gram) {
    for (Index k = 0; k < factor.cols(); k++) {
        if (!(gram(k, k) > 0)) continue;
        const VectorXf step = (product.col(k) - factor * gram.col(k)) / gram(k, k);
        factor.col(k) = (factor.col(k) + step).cwiseMax(0.0f);
    }
}

// Calls make(first, count) for ranges of up to kTogether of `size` rows, in parallel. The ranges do not
// depend on the number of threads, since products of other ranges may be rounded differently.
template <typename Make>
void forRanges(Index size, const Make& make) {
    constexpr Index kTogether = 128;
    tbb::parallel_for(Index(0), (size + kTogether - 1) / kTogether, [&](Index range) {
        const Index first = range * kTogether;
        make(first, std::min(kTogether, size - first));
    });
}

// Normalizes columns and sorts terms by the sizes of their products.
void normalize(LowRank& factors) {
    const Index terms = factors.left.cols();
    for (Index k = 0; k < terms; k++) {
        const double left = double(factors.left.col(k).norm()),
                     right = std::sqrt(squaredNorm(factors.right, k));
        factors.values[k] = float(left * right);
        if (left > 0) factors.left.col(k) /= float(left);
        for (MatrixXf& block : factors.right)
            if (right > 0) block.col(k) /= float(right);
    }
    std::vector<Index> order(size_t(terms), 0);
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return factors.values[a] > factors.values[b]; });
    factors.values = factors.values(order).eval();
    factors.left = factors.left(Eigen::all, order).eval();
    for (MatrixXf& block : factors.right) block = block(Eigen::all, order).eval();
}

// Appends terms of zeros, up to `terms`.
LowRank padded(LowRank factors, int terms) {
    const auto widen = [&](MatrixXf& columns) {
        columns.conservativeResizeLike(MatrixXf::Zero(columns.rows(), terms));
    };
    widen(factors.left);
    for (MatrixXf& block : factors.right) widen(block);
    factors.values.conservativeResizeLike(VectorXf::Zero(terms));
    return factors;
}

} // namespace

LowRank nonNegativeLowRank(std::span<const MatrixXf> blocks, int terms) {
    LowRank factors = lowRank(blocks, terms);
    // A matrix of rank 1 or 2 has a nonnegative factorization of as many terms (Cohen, Rothblum: Nonnegative
    // ranks, 1993); further terms would only split these.
    const Index count = (factors.values.array() > kLeastValue * factors.values[0]).count();
    const Index rank = std::max<Index>(count, 1); // black has one term of zeros
    if (rank <= 2 && rank < terms) return padded(nonNegativeLowRank(blocks, int(rank)), terms);
    for (Index k = 0; k < terms; k++) startFromHalf(factors, k);
    for (int round = 0; round < kSweeps; round++) {
        const MatrixXf leftGram = factors.left.transpose() * factors.left;
        MatrixXf product = MatrixXf::Zero(factors.left.rows(), terms),
                 rightGram = MatrixXf::Zero(terms, terms);
        for (size_t j = 0; j < blocks.size(); j++) {
            MatrixXf& right = factors.right[j];
            MatrixXf rightProduct(right.rows(), terms);
            forRanges(right.rows(), [&](Index first, Index size) {
                rightProduct.middleRows(first, size).noalias() =
                    blocks[j].middleCols(first, size).transpose() * factors.left;
            });
            sweep(right, rightProduct, leftGram);
            forRanges(product.rows(), [&](Index first, Index size) {
                product.middleRows(first, size).noalias() += blocks[j].middleRows(first, size) * right;
            });
            rightGram.noalias() += right.transpose() * right;
        }
        sweep(factors.left, product, rightGram);
    }
    normalize(factors);
    return factors;
}

} // namespace relume

#include "precompute/brdf/low_rank.h"
#include "precompute/brdf/thin_matrix.h"

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

using Blocks = std::span<const MatrixXf>;

double squaredNorm(Blocks blocks, Index column) {
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
// given product = target · other and gram = otherᵀ · other. Rows do not depend on each other.
void sweep(Eigen::Ref<ThinMatrix> factor, const Eigen::Ref<const ThinMatrix>& product,
           const ThinMatrix& gram) {
    for (Index r = 0; r < factor.rows(); r++) {
        auto row = factor.row(r);
        for (Index k = 0; k < factor.cols(); k++)
            if (gram(k, k) > 0)
                row[k] = std::max(row[k] + (product(r, k) - row.dot(gram.row(k))) / gram(k, k), 0.0f);
    }
}

// A range of a block's columns, on which one thread works, and the sums over it.
struct Range {
    const MatrixXf& block;
    ThinMatrix& right;
    Index first, count;
    ThinMatrix product, gram; // block · right, rightᵀ · right
};

// Returns ranges that cover all blocks. They do not depend on the number of threads, so neither does any sum.
std::vector<Range> makeRanges(Blocks blocks, std::vector<ThinMatrix>& right) {
    constexpr Index kTogether = 128;
    std::vector<Range> ranges;
    for (size_t j = 0; j < blocks.size(); j++)
        for (Index first = 0; first < blocks[j].cols(); first += kTogether)
            ranges.push_back(
                {blocks[j], right[j], first, std::min(kTogether, blocks[j].cols() - first), {}, {}});
    return ranges;
}

// Sweeps over the range's rows of the right factor, and sums their products. A few columns at a time remain
// in the cache between both, so that a block is read once from memory.
void sweepRight(Range& range, const ThinMatrix& left, const ThinMatrix& leftGram) {
    constexpr Index kTogether = 16;
    range.product.setZero(left.rows(), left.cols());
    range.gram.setZero(left.cols(), left.cols());
    ThinMatrix product(kTogether, left.cols());
    for (Index done = 0; done < range.count; done += kTogether) {
        const Index first = range.first + done, count = std::min(kTogether, range.count - done);
        const auto columns = range.block.middleCols(first, count);
        auto right = range.right.middleRows(first, count);
        multiplyTransposed(columns, left, product.topRows(count));
        sweep(right, product.topRows(count), leftGram);
        addProduct(columns, right, range.product);
        range.gram += right.transpose().lazyProduct(right);
    }
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

LowRank nonNegativeLowRank(Blocks blocks, int terms) {
    LowRank factors = lowRank(blocks, terms);
    // A matrix of rank 1 or 2 has a nonnegative factorization of as many terms (Cohen, Rothblum: Nonnegative
    // ranks, 1993); further terms would only split these.
    const Index count = (factors.values.array() > kLeastValue * factors.values[0]).count();
    const Index rank = std::max<Index>(count, 1); // black has one term of zeros
    if (rank <= 2 && rank < terms) return padded(nonNegativeLowRank(blocks, int(rank)), terms);
    for (Index k = 0; k < terms; k++) startFromHalf(factors, k);
    ThinMatrix left = thinned(factors.left);
    std::vector<ThinMatrix> right;
    for (const MatrixXf& block : factors.right) right.push_back(thinned(block));
    std::vector<Range> ranges = makeRanges(blocks, right);
    for (int round = 0; round < kSweeps; round++) {
        const ThinMatrix leftGram = left.transpose().lazyProduct(left);
        tbb::parallel_for(size_t(0), ranges.size(), [&](size_t i) { sweepRight(ranges[i], left, leftGram); });
        ThinMatrix product = ThinMatrix::Zero(left.rows(), left.cols()),
                   rightGram = ThinMatrix::Zero(left.cols(), left.cols());
        for (const Range& range : ranges) {
            product += range.product;
            rightGram += range.gram;
        }
        sweep(left, product, rightGram);
    }
    factors.left = left.leftCols(terms);
    for (size_t j = 0; j < right.size(); j++) factors.right[j] = right[j].leftCols(terms);
    normalize(factors);
    return factors;
}

} // namespace relume

#include "precompute/brdf/eigenpairs.h"

#include "engine/base/check.h"
#include "engine/base/log.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <numeric>
#include <random>
#include <vector>

namespace relume {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXf;

namespace {

constexpr int kOversampling = 8; // pairs iterated beyond those wanted
// A glossy BRDF in a polar map has a cluster of S eigenvalues that differ by 1e-4, from mirror pairs at the
// rim. A smaller block would separate it slowly.
constexpr int kLeastBlock = 40;
constexpr int kBasisBlocks = 4; // size of a full basis, in blocks
constexpr int kMaxRounds = 300;

// Returns unit columns, uniform in direction up to the cube's corners. Made from bits, so that every standard
// library gives the same.
MatrixXf randomBlock(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
    const MatrixXf block =
        MatrixXf::NullaryExpr(rows, columns, [&] { return float(random() >> 8) * 0x1p-23f - 1.0f; });
    return block.colwise().normalized();
}

// Returns an orthonormal basis of the span of the block, whose columns have norm 1 at most; drops directions
// that are dependent or too short. Uses the eigenvectors of the Gram matrix (Stathopoulos and Wu, 2002),
// which is nearly all matrix products. One pass leaves an error of up to 1e-2, the second only rounding.
MatrixXf orthonormalized(const MatrixXf& block) {
    constexpr double kDependent = 1e-5;
    const MatrixXd gram = (block.transpose() * block).cast<double>();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(gram);
    const auto& squares = solver.eigenvalues();
    const double threshold = kDependent * std::max(1.0, squares[squares.size() - 1]);
    const auto kept = std::count_if(squares.begin(), squares.end(), [&](double s) { return s > threshold; });
    const MatrixXd scaled =
        solver.eigenvectors().rightCols(kept) * squares.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
    return block * scaled.cast<float>();
}

// Returns an orthonormal basis of what the block adds to the span of `basis`, orthogonal to it.
MatrixXf orthonormalizedAgainst(const Eigen::Ref<const MatrixXf>& basis, MatrixXf block) {
    for (int pass = 0; pass < 2 && block.cols() > 0; pass++) {
        block.noalias() -= basis * (basis.transpose() * block).eval();
        block = orthonormalized(block);
    }
    return block;
}

struct RitzPairs {
    VectorXf values;
    MatrixXf vectors;   // X
    MatrixXf residuals; // MX - X diag(values)
};

class BlockEigensolver {
  public:
    BlockEigensolver(const BlockOperator& apply, int dimension, int count, float tolerance)
        : mApply(apply), mDimension(dimension), mCount(count), mTolerance(tolerance),
          mBlock(std::min(dimension, std::max(count + kOversampling, kLeastBlock))),
          mBasis(dimension, kBasisBlocks * mBlock), mProduct(dimension, kBasisBlocks * mBlock) {}

    Eigenpairs solve() {
        std::mt19937 random(20040621);
        while (mSize < mBlock)
            append(orthonormalizedAgainst(basis(), randomBlock(random, mDimension, mBlock - mSize)));
        for (int round = 0; round < kMaxRounds; round++) {
            RitzPairs ritz = rayleighRitz();
            const std::vector<int> open = unconverged(ritz);
            if (open.empty() || open.front() >= mCount) return result(ritz);
            if (mSize + Eigen::Index(open.size()) > mBasis.cols()) restart(ritz);
            const MatrixXf directions = orthonormalizedAgainst(basis(), residualBlock(ritz, open));
            if (directions.cols() == 0) return result(ritz); // the basis is invariant
            append(directions);
        }
        log(LogLevel::Warning,
            fmt::format("eigenvalues: not converged to {} after {} rounds; the factors are less exact",
                        mTolerance, kMaxRounds));
        return result(rayleighRitz());
    }

  private:
    Eigen::Ref<const MatrixXf> basis() const { return mBasis.leftCols(mSize); }
    Eigen::Ref<const MatrixXf> product() const { return mProduct.leftCols(mSize); }

    void append(const MatrixXf& directions) {
        mBasis.middleCols(mSize, directions.cols()) = directions;
        mProduct.middleCols(mSize, directions.cols()) = mApply(directions);
        mSize += directions.cols();
    }

    // Returns the basis's best approximations to the mBlock pairs of largest magnitude.
    RitzPairs rayleighRitz() {
        const MatrixXd projected = (basis().transpose() * product()).cast<double>();
        const Eigen::SelfAdjointEigenSolver<MatrixXd> solver((projected + projected.transpose()) / 2);
        std::vector<int> order(size_t(projected.cols()));
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
            return std::abs(solver.eigenvalues()[a]) > std::abs(solver.eigenvalues()[b]);
        });
        order.resize(size_t(mBlock));
        mRotation = solver.eigenvectors()(Eigen::all, order).cast<float>();
        RitzPairs ritz;
        ritz.values = solver.eigenvalues()(order).cast<float>();
        ritz.vectors = basis() * mRotation;
        ritz.residuals = product() * mRotation;
        ritz.residuals -= ritz.vectors * ritz.values.asDiagonal();
        return ritz;
    }

    std::vector<int> unconverged(const RitzPairs& ritz) const {
        const float limit = mTolerance * std::abs(ritz.values[0]);
        std::vector<int> open;
        for (int k = 0; k < mBlock; k++)
            if (ritz.residuals.col(k).norm() > limit) open.push_back(k);
        return open;
    }

    static MatrixXf residualBlock(const RitzPairs& ritz, const std::vector<int>& open) {
        return ritz.residuals(Eigen::all, open).colwise().normalized();
    }

    void restart(const RitzPairs& ritz) {
        mProduct.leftCols(mBlock) = (product() * mRotation).eval();
        mBasis.leftCols(mBlock) = ritz.vectors;
        mSize = mBlock;
    }

    // Fixes the signs of vectors by their first component whose magnitude is within 0.1 % of the largest. An
    // antisymmetric vector has two of equal magnitude, and rounding must not decide between them.
    Eigenpairs result(const RitzPairs& ritz) const {
        Eigenpairs pairs{ritz.values.head(mCount), ritz.vectors.leftCols(mCount)};
        for (auto vector : pairs.vectors.colwise()) {
            const float threshold = 0.999f * vector.cwiseAbs().maxCoeff();
            const auto first =
                std::find_if(vector.begin(), vector.end(), [&](float v) { return std::abs(v) >= threshold; });
            if (*first < 0) vector = -vector;
        }
        return pairs;
    }

    const BlockOperator& mApply;
    int mDimension, mCount;
    float mTolerance;
    int mBlock;
    MatrixXf mBasis, mProduct; // allocated for V, orthonormal, and MV
    Eigen::Index mSize = 0;    // columns of V in use
    MatrixXf mRotation;        // from V to the latest Ritz vectors
};

} // namespace

Eigenpairs largestEigenpairs(const BlockOperator& apply, int dimension, int count, float tolerance) {
    RELUME_CHECK_LE(1, count);
    RELUME_CHECK_LE(count, dimension);
    return BlockEigensolver(apply, dimension, count, tolerance).solve();
}

Eigenpairs largestEigenpairs(const MatrixXf& symmetric, int count, float tolerance) {
    RELUME_CHECK_EQ(symmetric.rows(), symmetric.cols());
    RELUME_CHECK(symmetric.allFinite());
    const auto apply = [&](const MatrixXf& block) -> MatrixXf { return symmetric * block; };
    return largestEigenpairs(apply, int(symmetric.rows()), count, tolerance);
}

} // namespace relume

#include "precompute/brdf/thin_matrix.h"

#include "engine/base/check.h"
#include "engine/math/divide_up.h"

#include <algorithm>
#include <array>

namespace relume {

using Eigen::Index;
using Eigen::MatrixXf;

namespace {

using Lanes = Eigen::Array<float, kThinLanes, 1>;

// Columns of the large matrix that are multiplied together: as many sums as registers hold.
constexpr Index kColumns = 8;

// Calls multiply(columns, first, count) for every kColumns columns. The last may be fewer than the pointers,
// which then repeat one of them.
template <typename Multiply>
void forColumns(const Eigen::Ref<const MatrixXf>& large, const Multiply& multiply) {
    for (Index first = 0; first < large.cols(); first += kColumns) {
        const Index count = std::min(kColumns, large.cols() - first);
        std::array<const float*, kColumns> columns;
        for (Index c = 0; c < kColumns; c++)
            columns[size_t(c)] = large.data() + (first + std::min(c, count - 1)) * large.outerStride();
        multiply(columns, first, count);
    }
}

} // namespace

ThinMatrix thinned(const MatrixXf& matrix) {
    ThinMatrix thin =
        ThinMatrix::Zero(matrix.rows(), divideUp(uint32_t(matrix.cols()), uint32_t(kThinLanes)) * kThinLanes);
    thin.leftCols(matrix.cols()) = matrix;
    return thin;
}

void multiplyTransposed(const Eigen::Ref<const MatrixXf>& large, const ThinMatrix& thin,
                        Eigen::Ref<ThinMatrix> product) {
    RELUME_CHECK(thin.cols() % kThinLanes == 0 && product.cols() == thin.cols());
    RELUME_CHECK(thin.rows() == large.rows() && product.rows() == large.cols());
    for (Index lanes = 0; lanes < thin.cols(); lanes += kThinLanes)
        forColumns(large, [&](const auto& columns, Index first, Index count) {
            Lanes sums[kColumns];
            for (Lanes& sum : sums) sum.setZero();
            const float* row = thin.data() + lanes;
            for (Index r = 0; r < large.rows(); r++, row += thin.cols()) {
                const Lanes factors = Eigen::Map<const Lanes>(row);
                for (size_t c = 0; c < kColumns; c++) sums[c] += columns[c][r] * factors;
            }
            for (Index c = 0; c < count; c++) product.row(first + c).segment<kThinLanes>(lanes) = sums[c];
        });
}

void addProduct(const Eigen::Ref<const MatrixXf>& large, const Eigen::Ref<const ThinMatrix>& thin,
                ThinMatrix& product) {
    RELUME_CHECK(thin.cols() % kThinLanes == 0 && product.cols() == thin.cols());
    RELUME_CHECK(thin.rows() == large.cols() && product.rows() == large.rows());
    for (Index lanes = 0; lanes < thin.cols(); lanes += kThinLanes)
        forColumns(large, [&](const auto& columns, Index first, Index count) {
            Lanes factors[kColumns];
            for (Index c = 0; c < kColumns; c++)
                if (c < count)
                    factors[c] = thin.row(first + c).segment<kThinLanes>(lanes);
                else
                    factors[c].setZero();
            float* row = product.data() + lanes;
            for (Index r = 0; r < large.rows(); r++, row += product.cols()) {
                // Two sums, so that an addition need not wait for the one before.
                Lanes even = columns[0][r] * factors[0], odd = columns[1][r] * factors[1];
                for (size_t c = 2; c < kColumns; c += 2) {
                    even += columns[c][r] * factors[c];
                    odd += columns[c + 1][r] * factors[c + 1];
                }
                Eigen::Map<Lanes>(row) += even + odd;
            }
        });
}

} // namespace relume

// Low-rank approximation of several matrices by products that share their left factors.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace relume {

// blocks[j] ≈ left · diag(values) · right[j]ᵀ
struct LowRank {
    Eigen::VectorXf values;             // singular values of [block 0 | block 1 | …], descending
    Eigen::MatrixXf left;               // n × terms, orthonormal columns
    std::vector<Eigen::MatrixXf> right; // per block; columns stacked over the blocks are orthonormal
};

// Returns the largest singular triplets: the least-squares approximation of all blocks together. All blocks
// have n rows. Values below about 1e-6 of the first are rounding noise. Deterministic.
LowRank lowRank(std::span<const Eigen::MatrixXf> blocks, int terms);

// Factors nonnegative blocks into nonnegative factors by hierarchical alternating least squares (Cichocki,
// Zdunek and Amari 2007), initialized from the singular triplets (Boutsidis and Gallopoulos 2008). values[k]
// = ‖left_k‖ ‖right_k‖, descending; left and right are normalized as in lowRank(), but not orthogonal.
LowRank nonNegativeLowRank(std::span<const Eigen::MatrixXf> blocks, int terms);

} // namespace relume

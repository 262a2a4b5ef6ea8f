// The best approximation of a row of matrices by few products that share their left factors.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace relume {

// blocks[j] ≈ left · diag(values) · right[j]ᵀ
struct LowRank {
    Eigen::VectorXf values;             // singular values of [block 0 | block 1 | …], falling
    Eigen::MatrixXf left;               // n × terms, orthonormal columns
    std::vector<Eigen::MatrixXf> right; // per block; its columns stacked over the blocks are orthonormal
};

// The largest singular triplets, least squares over all blocks together. All blocks have n rows. Values below
// about 1e-6 of the first are rounding. Deterministic.
LowRank lowRank(std::span<const Eigen::MatrixXf> blocks, int terms);

// Factors without negative entries, by hierarchical alternating least squares (Cichocki, Zdunek and Amari
// 2007), started from the singular triplets (Boutsidis and Gallopoulos 2008). Blocks have no negative
// entries. values[k] = ‖left_k‖ ‖right_k‖ of the products, falling; left and right are normalized as in
// lowRank(), but not orthogonal.
LowRank nonNegativeLowRank(std::span<const Eigen::MatrixXf> blocks, int terms);

} // namespace relume

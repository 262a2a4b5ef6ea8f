// The eigenpairs of largest magnitude of a large symmetric matrix.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace relume {

struct Eigenpairs {
    Eigen::VectorXf values;  // by falling magnitude
    Eigen::MatrixXf vectors; // one column each, orthonormal; the component of largest magnitude is positive
};

// Block power iteration, its blocks accumulated into a Krylov basis: Rayleigh-Ritz on the basis, the block of
// residuals as its next part, a restart from the best Ritz vectors when it is full (the block Davidson method
// without preconditioner; Saad, Numerical Methods for Large Eigenvalue Problems, chapter 8). Ends when
// ‖Mv - λv‖ ≤ tolerance · |λ₁| for every wanted pair; a tolerance under some 1e-6 is below float's rounding.
// Pairs ±λ and multiple values (up to `count` + 8 fold) converge like any others. Deterministic.
Eigenpairs largestEigenpairs(const Eigen::MatrixXf& symmetric, int count, float tolerance = 1e-5f);

// The same for a symmetric linear operator given by its product with a block of vectors.
using BlockOperator = std::function<Eigen::MatrixXf(const Eigen::MatrixXf& block)>;
Eigenpairs largestEigenpairs(const BlockOperator& apply, int dimension, int count, float tolerance = 1e-5f);

} // namespace relume

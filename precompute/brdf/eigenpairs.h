// The eigenpairs of largest magnitude of a large symmetric matrix.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace relume {

struct Eigenpairs {
    Eigen::VectorXf values;  // by decreasing magnitude
    Eigen::MatrixXf vectors; // columns, orthonormal; the component of largest magnitude is positive
};

// Computes them by block power iteration accumulated into a Krylov basis: Rayleigh-Ritz on the basis,
// extended by the block of residuals, restarted from the best Ritz vectors when full (the block Davidson
// method without preconditioner; Saad, Numerical Methods for Large Eigenvalue Problems, chapter 8). Ends when
// ‖Mv - λv‖ ≤ tolerance · |λ₁| for every wanted pair; a tolerance below about 1e-6 is lost in float rounding.
// Pairs ±λ and multiple eigenvalues (up to `count` + 8 fold) converge like others. Deterministic.
Eigenpairs largestEigenpairs(const Eigen::MatrixXf& symmetric, int count, float tolerance = 1e-5f);

// Does the same for a symmetric linear operator, given by its product with a block of vectors.
using BlockOperator = std::function<Eigen::MatrixXf(const Eigen::MatrixXf& block)>;
Eigenpairs largestEigenpairs(const BlockOperator& apply, int dimension, int count, float tolerance = 1e-5f);

} // namespace relume

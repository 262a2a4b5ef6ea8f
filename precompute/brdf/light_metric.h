// Weights for errors of f by their effect on reflected radiance under typical environments.
#pragma once

#include "precompute/brdf/tabulation.h"

namespace relume {

// Returns Y, n × n and upper triangular, with ‖Y e‖² = E[(∫ L(ω) e(ω) cosθ dω)²] for an error e of f over the
// table's n incoming directions: the mean square error of reflected radiance. Lights L are rotated at random;
// their power per spherical-harmonic coefficient falls with the degree l as (1 + l)^-1.5, above a white floor
// of 2 %. Real environments follow such a power law (Dror, Leung, Adelson and Willsky 2001); the floor stands
// for lamps, windows and suns. docs/factorization.md shows how little the exponent matters.
Eigen::MatrixXf lightMetric(const BrdfTable& table);

// Returns the square roots of the weights of outgoing directions, cosθ · solid angle: the share of a convex
// object's pixels that see it from there.
Eigen::VectorXf viewMetric(const BrdfTable& table);

} // namespace relume

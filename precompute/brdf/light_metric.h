// What environments ask of a BRDF's light side: which errors of f change reflected radiance, and by how much.
#pragma once

#include "precompute/brdf/tabulation.h"

namespace relume {

// A matrix Y, n × n and upper triangular, with ‖Y e‖² = E[(∫ L(ω) e(ω) cosθ dω)²] for an error e of f over
// the table's n incoming directions: the mean square of the error of reflected radiance under lights L that
// are turned every way and whose power per spherical-harmonic coefficient falls with the degree l as (1 +
// l)^-1.5, over a floor of 2 % of white. Real environments are like that: a power law (Dror, Leung, Adelson
// and Willsky 2001), and the floor of their lamps, windows and suns. docs/factorization.md shows how little
// the exponent matters.
Eigen::MatrixXf lightMetric(const BrdfTable& table);

// Square roots of the weights of outgoing directions: cosθ · solid angle, the share of pixels that see a
// convex object from there.
Eigen::VectorXf viewMetric(const BrdfTable& table);

} // namespace relume

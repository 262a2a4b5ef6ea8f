// Cuts all clusters at one slope of error against bytes, their price, which gives the whole the least error
// for its bytes (Shoham and Gersho 1988). A cluster's weight is how many it stands for.
#pragma once

#include "precompute/layout/basis_analysis.h"

namespace relume {

struct CutTotals {
    double bytes = 0;
    double error = 0; // squared, in units of the matrices, but for quantisation
};

// Of all clusters' cuts at a price: an error that a byte must save.
CutTotals totalsAt(std::span<const BasisAnalysis> clusters, double price);

// The price at which all cuts together have `bytes`, or the most below.
double priceForBytes(std::span<const BasisAnalysis> clusters, double bytes);

// The highest price at which the squared error is at most `error`; else what leaves the least.
double priceForError(std::span<const BasisAnalysis> clusters, double error);

} // namespace relume

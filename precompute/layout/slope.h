// One price of a byte for all clusters: the whole has then the least error for its bytes. Clusters and
// columns may stand for several (their weight).
#pragma once

#include "precompute/layout/basis_analysis.h"

namespace relume {

// What a column of clusters holds, squared, and how many such there are.
struct ColumnEnergy {
    float energy, weight;
};

// The least energy of columns that are to be kept, of which the strongest together have at most `bytes`.
float thresholdForBytes(std::vector<ColumnEnergy> columns, double bytes);

// The highest at which the columns that are dropped hold at most `error` together, squared; 0 to keep all.
float thresholdForError(std::vector<ColumnEnergy> columns, double error);

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

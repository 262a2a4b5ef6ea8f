#include "precompute/layout/slope.h"

#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// Neighbouring prices.
struct Prices {
    double low, high;
};

// Those between which `isHigh` turns true, by halving of a range beyond which nothing changes.
template <typename IsHigh>
Prices pricesAround(const IsHigh& isHigh) {
    double low = -80, high = 20;
    for (int i = 0; i < 36; i++) {
        const double middle = 0.5 * (low + high);
        (isHigh(std::exp2(middle)) ? high : low) = middle;
    }
    return {std::exp2(low), std::exp2(high)};
}

} // namespace

CutTotals totalsAt(std::span<const BasisAnalysis> clusters, double price) {
    std::vector<CutTotals> each(clusters.size());
    tbb::parallel_for(size_t(0), clusters.size(), [&](size_t i) {
        const BasisCut cut = cutFor(clusters[i], price);
        each[i] = {clusters[i].weight * cut.bytes, clusters[i].weight * cut.error};
    });
    CutTotals sum;
    for (const CutTotals& one : each) sum.bytes += one.bytes, sum.error += one.error;
    return sum;
}

double priceForBytes(std::span<const BasisAnalysis> clusters, double bytes) {
    return pricesAround([&](double price) { return totalsAt(clusters, price).bytes <= bytes; }).high;
}

double priceForError(std::span<const BasisAnalysis> clusters, double error) {
    return pricesAround([&](double price) { return totalsAt(clusters, price).error > error; }).low;
}

} // namespace relume

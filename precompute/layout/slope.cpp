#include "precompute/layout/slope.h"

#include "engine/transport/clustered_transport.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

void sortByEnergy(std::vector<ColumnEnergy>& columns) {
    std::ranges::sort(columns, [](const ColumnEnergy& a, const ColumnEnergy& b) {
        return a.energy != b.energy ? a.energy > b.energy : a.weight > b.weight;
    });
}

// Just more than an energy.
float above(float energy) { return std::nextafter(energy, std::numeric_limits<float>::infinity()); }

} // namespace

float thresholdForBytes(std::vector<ColumnEnergy> columns, double bytes) {
    constexpr double kColumnBytes = sizeof(uint16_t) + sizeof(uint32_t) * kClusterVertices;
    sortByEnergy(columns);
    size_t kept = 0;
    for (double taken = 0; kept < columns.size(); kept++) {
        taken += double(columns[kept].weight) * kColumnBytes;
        if (taken > bytes) break;
    }
    // Of equal ones at the edge all are dropped, to stay within the budget.
    return kept < columns.size() ? above(columns[kept].energy) : 0.0f;
}

float thresholdForError(std::vector<ColumnEnergy> columns, double error) {
    sortByEnergy(columns);
    size_t kept = columns.size();
    for (double left = 0; kept > 0; kept--) {
        left += double(columns[kept - 1].weight) * double(columns[kept - 1].energy);
        if (left > error) break;
    }
    if (kept == columns.size()) return 0;
    // Of equal ones at the edge all are kept, to stay within the error.
    return kept > 0 ? columns[kept - 1].energy : above(columns[0].energy);
}

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

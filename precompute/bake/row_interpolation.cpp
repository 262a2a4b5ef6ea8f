#include "precompute/bake/row_interpolation.h"

namespace relume {

RowInterpolator::RowInterpolator(const BakedRows& coarse, int coefficients, int kept)
    : mCoarse(coarse), mKept(kept), mSum(size_t(coefficients)) {}

void RowInterpolator::append(std::span<const CoarseNeighbor> neighbors, BakedRows& rows) {
    if (neighbors.size() == 1) {
        const uint32_t vertex = neighbors.front().coarse;
        rows.append(mCoarse.vertices(vertex, vertex + 1));
        return;
    }
    for (uint32_t term = 0; term < mCoarse.transport.terms; term++) appendSum(neighbors, term, rows);
    rows.transport.vertices++;
}

void RowInterpolator::appendSum(std::span<const CoarseNeighbor> neighbors, uint32_t term, BakedRows& rows) {
    TransportLosses losses;
    for (const CoarseNeighbor& neighbor : neighbors) {
        const size_t row = size_t(neighbor.coarse) * mCoarse.transport.terms + term;
        mSum.add(mCoarse.transport, row, neighbor.weight);
        losses.total += double(neighbor.weight) * mCoarse.losses[row].total;
        losses.dropped += double(neighbor.weight) * mCoarse.losses[row].dropped;
        losses.quantized += double(neighbor.weight) * mCoarse.losses[row].quantized;
    }
    appendRow(rows.transport, mSum.pack(mKept));
    rows.losses.push_back(losses);
}

} // namespace relume

#include "precompute/bake/row_interpolation.h"

namespace relume {

RowInterpolator::RowInterpolator(const BakedRows& coarse, int coefficients, int kept)
    : mCoarse(coarse), mKept(kept), mSum(size_t(coefficients)) {}

void RowInterpolator::append(std::span<const CoarseNeighbour> neighbours, BakedRows& rows) {
    if (neighbours.size() == 1) {
        const uint32_t vertex = neighbours.front().coarse;
        rows.append(mCoarse.vertices(vertex, vertex + 1));
        return;
    }
    for (uint32_t term = 0; term < mCoarse.transport.terms; term++) appendSum(neighbours, term, rows);
    rows.transport.vertices++;
}

void RowInterpolator::appendSum(std::span<const CoarseNeighbour> neighbours, uint32_t term, BakedRows& rows) {
    TransportLosses losses;
    for (const CoarseNeighbour& neighbour : neighbours) {
        const size_t row = size_t(neighbour.coarse) * mCoarse.transport.terms + term;
        mSum.add(mCoarse.transport, row, neighbour.weight);
        losses.total += double(neighbour.weight) * mCoarse.losses[row].total;
        losses.dropped += double(neighbour.weight) * mCoarse.losses[row].dropped;
        losses.quantised += double(neighbour.weight) * mCoarse.losses[row].quantised;
    }
    appendRow(rows.transport, mSum.pack(mKept));
    rows.losses.push_back(losses);
}

} // namespace relume

#include "precompute/bake/row_interpolation.h"

#include "precompute/transport/row_packing.h"

#include <bit>
#include <utility>

namespace relume {

RowInterpolator::RowInterpolator(const BakedRows& coarse, int coefficients, int kept)
    : mCoarse(coarse), mKept(kept), mSums(size_t(coefficients), vec3(0)),
      mTouched((size_t(coefficients) + 63) / 64) {}

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
    const SparseTransport& from = mCoarse.transport;
    TransportLosses losses;
    for (const CoarseNeighbour& neighbour : neighbours) {
        const size_t row = size_t(neighbour.coarse) * from.terms + term;
        const vec3 step =
            neighbour.weight * from.scales[row] / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum);
        for (uint64_t entry = from.rowStarts[row]; entry < from.rowStarts[row + 1]; entry++) {
            const uint16_t index = from.indices[entry];
            mSums[index] += step * vec3(unpackCoefficient(from.values[entry]));
            mTouched[index / 64] |= uint64_t(1) << index % 64;
        }
        losses.total += double(neighbour.weight) * mCoarse.losses[row].total;
        losses.dropped += double(neighbour.weight) * mCoarse.losses[row].dropped;
        losses.quantised += double(neighbour.weight) * mCoarse.losses[row].quantised;
    }
    std::vector<uint16_t> indices; // rising, so that the packers' ties are as among all coefficients
    std::vector<vec3> values;
    for (size_t word = 0; word < mTouched.size(); word++)
        for (; mTouched[word] != 0; mTouched[word] &= mTouched[word] - 1) {
            indices.push_back(uint16_t(word * 64 + size_t(std::countr_zero(mTouched[word]))));
            values.push_back(std::exchange(mSums[indices.back()], vec3(0)));
        }
    const PackedRow row = packLargest(values, mKept);
    SparseTransport& to = rows.transport;
    for (const uint16_t place : row.indices) to.indices.push_back(indices[place]);
    to.values.insert(to.values.end(), row.values.begin(), row.values.end());
    to.scales.push_back(row.scale);
    to.rowStarts.push_back(to.entries());
    rows.losses.push_back(losses);
}

} // namespace relume

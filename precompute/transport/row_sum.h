// Sums sparse rows and packs the result as a row.
#pragma once

#include "engine/transport/rows/sparse_transport.h"
#include "precompute/transport/row_packing.h"

#include <bit>
#include <utility>

namespace relume {

// Accumulates one row at a time; pack() empties it.
class RowSum {
  public:
    explicit RowSum(size_t coefficients);

    void add(size_t coefficient, vec3 value) {
        mSums[coefficient] += value;
        mTouched[coefficient / 64] |= uint64_t(1) << coefficient % 64;
    }
    // Adds `weight` times a row, whose coefficient i is added to coefficient place(i).
    template <typename Place>
    void add(const SparseTransport& rows, size_t row, float weight, const Place& place) {
        const vec3 step = weight * rows.scales[row] * kCoefficientUnit;
        for (uint64_t entry = rows.rowStarts[row]; entry < rows.rowStarts[row + 1]; entry++)
            add(place(rows.indices[entry]), step * vec3(unpackCoefficient(rows.values[entry])));
    }
    void add(const SparseTransport& rows, size_t row, float weight) {
        add(rows, row, weight, [](uint16_t index) { return index; });
    }

    // Calls take(coefficient, value) for each coefficient that something was added to, ascending, and empties
    // the sum.
    template <typename Take>
    void drain(const Take& take) {
        for (size_t word = 0; word < mTouched.size(); word++)
            for (; mTouched[word] != 0; mTouched[word] &= mTouched[word] - 1) {
                const size_t coefficient = word * 64 + size_t(std::countr_zero(mTouched[word]));
                take(coefficient, std::exchange(mSums[coefficient], vec3(0)));
            }
    }

    // Returns the sum's `kept` largest coefficients, packed by packLargest(). `energies`, if given, receives
    // sums of squares: of all coefficients, of the dropped ones, and of the quantization errors of the
    // others.
    struct Energies {
        double total = 0, dropped = 0, quantized = 0;
    };
    PackedRow pack(int kept, Energies* energies = nullptr);

  private:
    std::vector<vec3> mSums;        // per coefficient
    std::vector<uint64_t> mTouched; // one bit per coefficient
};

// Returns rows without vertices.
SparseTransport emptyRows(uint32_t terms);

// Returns Σ |coefficient|² of a row.
double energyOf(const SparseTransport& rows, size_t row);

// Appends a row to `rows`, without counting it in `rows.vertices`.
void appendRow(SparseTransport& rows, const PackedRow& row);

// Appends the vertices of `more`, which has the same number of terms.
void appendRows(SparseTransport& rows, const SparseTransport& more);

} // namespace relume

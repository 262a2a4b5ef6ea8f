// Packs rows of coefficients on the device: selects the largest of each, quantizes and compacts them.
#pragma once

#include "engine/transport/rows/sparse_transport.h"
#include "engine/vk/commands.h"

namespace relume {

// The losses of one or more rows, as sums of squares.
struct TransportLosses {
    double total = 0;     // of all coefficients
    double dropped = 0;   // lost by keeping only N
    double quantized = 0; // lost by quantization
    double layout = 0;    // lost by the layout, weighted and normalized as in ClusterMatrix

    void add(const TransportLosses& other) {
        total += other.total;
        dropped += other.dropped;
        quantized += other.quantized;
        layout += other.layout;
    }
};

// Packed rows in mapped buffers, which the device writes and the host reads.
struct PackedRows {
    // Has room for `rows` rows of `kept` entries. Throws OutOfMemory.
    PackedRows(const vk::Device& device, uint64_t rows, int kept);

    // Appends row number `row` to `transport`, without counting its vertex, and its losses to `losses`.
    // `firstEntry` is the sum of the rows before it; it is moved on to the next row.
    void append(uint32_t row, uint64_t& firstEntry, SparseTransport& transport,
                std::vector<TransportLosses>& losses) const;

    vk::Buffer counts, scales, statistics, entries;
};

// Packs the rows in coefficients() into PackedRows. CPU twins are in precompute/twins/transport_twin.h.
class PackingPass {
  public:
    // A row covers a cube of `faceSize` texels along a side of a face, and `kept` of its coefficients are
    // kept. A submission has at most `rows` rows, `rowsTogether` of them at a time. `lanes` is a power of
    // two, at most 64. Throws OutOfMemory.
    PackingPass(const vk::Device& device, int faceSize, int kept, uint64_t rows, uint64_t rowsTogether,
                uint32_t lanes);

    // Returns the SPIR-V of all its kernels.
    static std::vector<std::span<const uint32_t>> kernels();

    // The rows to pack, laid out as in shaders/lib/haar_block.glsl (haarSlot()), and the summaries of their
    // blocks.
    const vk::Buffer& coefficients() const { return mCoefficients; }
    const vk::Buffer& summaries() const { return mSummaries; }

    // Records selection and quantization of the first `rows` rows; they become those from `firstRow` on of
    // `packed`.
    void recordSelection(vk::Commands& commands, const PackedRows& packed, uint32_t rows,
                         uint32_t firstRow) const;
    // Records the compaction of all `rows` rows that were selected into `packed`.
    void recordCompaction(vk::Commands& commands, const PackedRows& packed, uint32_t rows) const;

    // Returns the bytes of the coefficients of one row, and of its blocks' summaries.
    static uint64_t coefficientBytes(int faceSize);
    static uint64_t summaryBytes(int faceSize);

  private:
    uint32_t mKept;
    vk::Buffer mCoefficients, mSummaries, mSelected, mSelectedCounts, mValues, mStarts;
    vk::ComputeProgram mSelect, mQuantize, mRowStarts, mCompact;
};

} // namespace relume

// From visibility bits to packed transport rows of one part, all on the device.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/rows/sparse_transport.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"
#include "shaders/shared/bake.h"

namespace relume {

// Sums of squares of a row, or over rows: what the bake measured of its own losses.
struct TransportLosses {
    double total = 0;     // of all coefficients
    double dropped = 0;   // lost by keeping N
    double quantized = 0; // lost by quantization
    double layout = 0;    // lost by the layout, weighed and in units as ClusterMatrix has them

    void add(const TransportLosses& other) {
        total += other.total;
        dropped += other.dropped;
        quantized += other.quantized;
        layout += other.layout;
    }
};

// How the kernels are cut for a device. Rows are the same for any; what they lost, but for rounding.
struct TransportTuning {
    uint32_t lanes;            // of a workgroup: a power of two, at most 64
    uint64_t coefficientBytes; // of rows that are worked on together, about

    static TransportTuning of(const vk::Device& device);
};

// Evaluates, transforms, selects, quantizes and compacts a batch of points at a time. Terms that do not
// fit a storage buffer together take turns, and so do points as tuning asks.
class TransportPass {
  public:
    TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                  uint32_t capacity)
        : TransportPass(device, brdf, options, capacity, TransportTuning::of(device)) {}
    TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                  uint32_t capacity, const TransportTuning& tuning);

    // SPIR-V of all kernels of it.
    static std::vector<std::span<const uint32_t>> kernels();

    // Records all terms of the first `count` BakePoints, whose bits lie at the front of `bits`.
    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const;

    // After the submission: appends the batch's rows, and what each lost.
    void collect(uint32_t count, SparseTransport& transport, std::vector<TransportLosses>& losses) const;

    // The coefficients of the last term group, and of the last points that were worked on together, for
    // parity tests. Rows are laid out as in shaders/lib/haar_block.glsl, see haarSlot(); blocks of texels
    // that nothing reaches are left as they were.
    const vk::Buffer& coefficients() const { return mCoefficients; }

    static uint64_t rowBytes(const BakeOptions& options); // of the coefficients of one row

    // Device and host-visible bytes that one point of a batch takes; and points that fit one storage buffer.
    static uint64_t bytesPerPoint(int terms, const BakeOptions& options);
    static uint32_t largestBatch(const vk::Device& device, const BakeOptions& options);

  private:
    // Terms that are evaluated together, and what comes back of them.
    struct TermGroup {
        uint32_t firstTerm, terms;
        vk::Buffer counts, scales, statistics, entries; // mapped
    };
    void recordGroup(vk::Commands& commands, const TermGroup& group, const vk::Buffer& points, uint32_t count,
                     const vk::Buffer& bits) const;

    uint32_t mFaceSize, mKept, mTogether;
    vk::Buffer mCorners;
    std::vector<TermGroup> mGroups;
    vk::Buffer mCoefficients, mSelected, mSelectedCounts, mValues, mStarts, mSummaries;
    vk::ComputeProgram mTransport, mSelect, mQuantize, mRowStarts, mCompact;
};

} // namespace relume

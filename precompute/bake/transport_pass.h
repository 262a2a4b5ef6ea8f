// From visibility bits to packed transport rows of one part, all on the device.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/sparse_transport.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"
#include "shaders/shared/bake.h"

namespace relume {

// Sums of squares of a row, or over rows: what the bake measured of its own losses.
struct TransportLosses {
    double total = 0;     // of all coefficients
    double dropped = 0;   // lost by keeping N
    double quantised = 0; // lost by quantisation

    void add(const TransportLosses& other) {
        total += other.total;
        dropped += other.dropped;
        quantised += other.quantised;
    }
};

// Evaluates, transforms, selects, quantises and compacts a batch of points at a time. Terms that do not
// fit a storage buffer together take turns.
class TransportPass {
  public:
    TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                  uint32_t capacity);

    // SPIR-V of all kernels of it.
    static std::vector<std::span<const uint32_t>> kernels();

    // Records all terms of the first `count` BakePoints, whose bits lie at the front of `bits`.
    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const;

    // After the submission: appends the batch's rows, and what each lost.
    void collect(uint32_t count, SparseTransport& transport, std::vector<TransportLosses>& losses) const;

    // The coefficients of the last term group, row by row, for parity tests: see record()'s kernels. Blocks
    // of texels that nothing reaches are left as they were.
    const vk::Buffer& coefficients() const { return mCoefficients; }

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

    uint32_t mFaceSize, mKept;
    vk::Image mLightMaps;
    vk::Sampler mSampler;
    std::vector<TermGroup> mGroups;
    vk::Buffer mCoefficients, mSelected, mSelectedCounts, mValues, mStarts, mBlocks;
    vk::ComputeProgram mTransport, mHaar, mSelect, mQuantise, mRowStarts, mCompact;
};

} // namespace relume

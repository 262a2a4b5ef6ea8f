// Computes packed transport rows of one part from visibility bits, all on the device.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/rows/sparse_transport.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"
#include "precompute/transport/packing_pass.h"

#include <optional>

namespace relume {

// Tuning of the kernels for a device. Does not change rows; losses may differ by rounding.
struct TransportTuning {
    uint32_t lanes;            // per workgroup: a power of two, at most 64
    uint64_t coefficientBytes; // approximate size of the coefficients processed together

    static TransportTuning of(const vk::Device& device);
};

// Evaluates, transforms, selects, quantizes and compacts the rows of a batch of points. Works on as many
// terms at a time as fit a storage buffer, and on as many points at a time as `tuning` says.
class TransportPass {
  public:
    TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                  uint32_t capacity)
        : TransportPass(device, brdf, options, capacity, TransportTuning::of(device)) {}
    TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                  uint32_t capacity, const TransportTuning& tuning);

    // Returns the SPIR-V of all its kernels.
    static std::vector<std::span<const uint32_t>> kernels();

    // Records all terms of the first `count` BakePoints of `points`, whose visibility bits are at the start
    // of `bits`.
    void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                const vk::Buffer& bits) const;

    // Appends the batch's rows and the losses of each. To be called after the submission.
    void collect(uint32_t count, SparseTransport& transport, std::vector<TransportLosses>& losses) const;

    // Returns, for parity tests, the coefficients of the last term group and the last points processed
    // together. Rows are laid out as in shaders/lib/haar_block.glsl (haarSlot()); blocks that no light
    // reaches keep their old content.
    const vk::Buffer& coefficients() const { return mPacking->coefficients(); }

    // Returns the device and host-visible bytes per point of a batch, whose `terms` rows have `entries`
    // entries in all; and how many points fit a storage buffer.
    static uint64_t bytesPerPoint(int terms, uint64_t entries, const BakeOptions& options);
    static uint32_t largestBatch(const vk::Device& device, const BakeOptions& options);

  private:
    // Terms that are processed together, and their rows, ordered by point, then term.
    struct TermGroup {
        uint32_t firstTerm, terms;
        PackedRows rows;
    };
    void recordGroup(vk::Commands& commands, const TermGroup& group, const vk::Buffer& points, uint32_t count,
                     const vk::Buffer& bits) const;

    uint32_t mTerms;    // K
    uint32_t mMapSize;  // S
    uint32_t mTogether; // points
    vk::Buffer mCorners;
    std::vector<TermGroup> mGroups;
    std::optional<PackingPass> mPacking;
    vk::ComputeProgram mTransport;
};

} // namespace relume

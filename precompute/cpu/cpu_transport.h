// Computes transport and its Haar transform on the CPU, for all terms of a part at once.
#pragma once

#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace relume {

// Terms are processed in groups that share vector registers: 4 terms, or 1 if the part has only one. A texel
// of a group stores its red values, then green, then blue; a single term is padded to 4 floats.
constexpr int groupLanes(int terms) { return terms == 1 ? 1 : 4; }
constexpr int groupStride(int terms) { return terms == 1 ? 4 : 12; }

// The coefficients of one vertex that can be nonzero; workspace of one thread. A block of kBlock holds the
// details of two levels over 4 × 4 texels; the last block of a face also holds the face's average.
struct CpuCoefficients {
    static constexpr int kBlock = 16;

    int groups = 0, lanes = 0, stride = 0;
    size_t capacity = 0;          // greatest number of blocks
    std::vector<uint32_t> blocks; // per block: its index for CpuTransport::indices()
    // Per group: `capacity` blocks of 16 texels × stride; see block().
    std::vector<float> values;
    std::vector<float> maxima;  // per block and lane: the largest key (r² + g² + b²)
    std::vector<double> energy; // per group and lane: sum of the keys

    float* block(int group, size_t index) {
        return &values[(size_t(group) * capacity + index) * kBlock * size_t(stride)];
    }
    const float* block(int group, size_t index) const {
        return &values[(size_t(group) * capacity + index) * kBlock * size_t(stride)];
    }
    const float* blockMaxima(int group, size_t index) const {
        return &maxima[(size_t(group) * capacity + index) * size_t(lanes)];
    }

    // Averages of the blocks of each round, dense: zero where there is no block.
    std::vector<std::vector<float>> averages;
};

// Evaluates the transport of vertices for the light maps of several BRDFs together.
class CpuTransport {
  public:
    // Takes the light maps of all `brdfs` in order; they have one size and mapping. Sizes and samples are as
    // in BakeOptions.
    CpuTransport(std::span<const FactoredBrdf* const> brdfs, int faceSize, int visibilitySize, int samples);

    int terms() const { return mTerms; }
    CpuCoefficients makeWorkspace() const;

    // Computes light map · cosine · solid angle · visible fraction, summed over each lighting texel, for the
    // blocks of which anything is visible: transportVector() in precompute/twins/transport_twin.h. `bits` are
    // from CpuVisibility.
    void evaluate(const TangentFrame& frame, std::span<const uint64_t> bits, CpuCoefficients& result) const;

    // Applies haarForwardFaces() in place, and fills in the maxima and energy that selection needs.
    void transform(CpuCoefficients& result) const;

    // The coefficient index, face · F² + y · F + x, of each of a block's 16 places.
    using BlockIndices = std::array<uint16_t, CpuCoefficients::kBlock>;
    const BlockIndices& indices(uint32_t block) const { return mIndices[block]; }

  private:
    template <int Stride>
    void evaluateBlocks(const TangentFrame& frame, std::span<const uint64_t> bits,
                        CpuCoefficients& result) const;
    template <int Stride>
    void transformBlocks(CpuCoefficients& result) const;

    int mTerms = 0, mMapSize = 0, mSamples;
    int mCellTexels; // visibility texels per evaluation
    DiskMapping mMapping{};
    std::vector<float> mMaps;                   // per group and texel: stride floats
    std::vector<float> mX, mY, mZ, mSolidAngle; // per evaluation, along the Morton curve
    std::vector<BlockIndices> mIndices;         // round after round
    // Two wavelet levels, or the last one of an odd number, which turn `blocks` blocks into as many averages.
    struct Round {
        uint32_t blocks, firstBlock;
        bool isSingleLevel;
    };
    std::vector<Round> mRounds;
};

} // namespace relume

// Transport and its Haar transform on the CPU: all terms of a part at once.
#pragma once

#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace relume {

// Terms that share vector registers: 4, or 1 where a part has a single one. A texel of a group is its red
// values, then green, then blue; a single term is padded to 4 floats.
constexpr int groupLanes(int terms) { return terms == 1 ? 1 : 4; }
constexpr int groupStride(int terms) { return terms == 1 ? 4 : 12; }

// The coefficients of one vertex, those that can be other than zero: in blocks of kBlock, which are the
// details of two levels over 4 × 4 texels, and the face's average in a face's last. One thread's workspace.
struct CpuCoefficients {
    static constexpr int kBlock = 16;

    int groups = 0, lanes = 0, stride = 0;
    size_t capacity = 0;          // blocks there can be
    std::vector<uint32_t> blocks; // of each block, its row of CpuTransport::indices()
    // Group after group, `capacity` blocks each: block · (16 texels × stride), block · lanes.
    std::vector<float> values;
    std::vector<float> maxima;  // the largest key (r² + g² + b²) of a block
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

    // Averages of the blocks of each round, dense: zero where a block has none.
    std::vector<std::vector<float>> averages;
};

class CpuTransport {
  public:
    // Light maps of all `brdfs`, one after the other, of one size and mapping. Sizes and samples as in
    // BakeOptions.
    CpuTransport(std::span<const FactoredBrdf* const> brdfs, int faceSize, int visibilitySize, int samples);

    int terms() const { return mTerms; }
    CpuCoefficients makeWorkspace() const;

    // Light map · cosine · solid angle · visible fraction, summed over each lighting texel, for the texels of
    // the blocks that see anything: transportVector in precompute/twins/transport_twin.h. `bits` as
    // CpuVisibility gives them.
    void evaluate(const TangentFrame& frame, std::span<const uint64_t> bits, CpuCoefficients& result) const;

    // Then haarForwardFaces, in place, with what selection wants to know of every block.
    void transform(CpuCoefficients& result) const;

    // The coefficient that each of a block's 16 places holds: face · F² + y · F + x.
    using BlockIndices = std::array<uint16_t, CpuCoefficients::kBlock>;
    const BlockIndices& indices(uint32_t block) const { return mIndices[block]; }

  private:
    template <int Stride>
    void evaluateBlocks(const TangentFrame& frame, std::span<const uint64_t> bits,
                        CpuCoefficients& result) const;
    template <int Stride>
    void transformBlocks(CpuCoefficients& result) const;

    int mTerms = 0, mMapSize = 0, mSamples;
    int mCellTexels; // visibility texels of one evaluation
    DiskMapping mMapping{};
    std::vector<float> mMaps;                   // group after group, texel after texel, stride floats
    std::vector<float> mX, mY, mZ, mSolidAngle; // of each evaluation, along the curve; over its texels
    std::vector<BlockIndices> mIndices;         // round after round
    // Two wavelet levels, or the last of an odd number, turn `blocks` blocks into as many averages.
    struct Round {
        uint32_t blocks, firstBlock;
        bool isSingleLevel;
    };
    std::vector<Round> mRounds;
};

} // namespace relume

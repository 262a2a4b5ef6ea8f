#include "apps/bench/cpu_rows.h"

#include <algorithm>
#include <bit>
#include <functional>

namespace relume {

namespace {

constexpr int kBlock = CpuCoefficients::kBlock;

vec3 coefficientAt(const CpuCoefficients& coefficients, int group, int lane, uint32_t place) {
    const float* texel = coefficients.block(group, 0) + size_t(place) * size_t(coefficients.stride);
    return {texel[lane], texel[coefficients.lanes + lane], texel[2 * coefficients.lanes + lane]};
}

float keyOf(vec3 c) { return c.x * c.x + c.y * c.y + c.z * c.z; }

} // namespace

void CpuRowPacker::select(const CpuCoefficients& coefficients, int group, int lane) {
    const size_t blocks = coefficients.blocks.size();
    // Lower bound: if N blocks have a key of at least b, the N-th largest key is at least b.
    float bound = 0;
    if (blocks > mKept) {
        mBounds.clear();
        for (size_t block = 0; block < blocks; block++)
            mBounds.push_back(coefficients.blockMaxima(group, block)[lane]);
        const auto last = mBounds.begin() + std::ptrdiff_t(mKept - 1);
        std::nth_element(mBounds.begin(), last, mBounds.end(), std::greater<>());
        bound = *last;
    }
    mCandidates.clear();
    for (uint32_t block = 0; block < blocks; block++) {
        if (!(coefficients.blockMaxima(group, block)[lane] >= bound)) continue;
        const CpuTransport::BlockIndices& indices = mTransport.indices(coefficients.blocks[block]);
        for (uint32_t i = 0; i < kBlock; i++) {
            const uint32_t place = block * kBlock + i;
            const float key = keyOf(coefficientAt(coefficients, group, lane, place));
            if (!(key > 0 && key >= bound)) continue;
            // Nonnegative floats order like their bits; of equal ones the lower index comes first.
            mCandidates.push_back(uint64_t(std::bit_cast<uint32_t>(key)) << 32 |
                                  uint64_t(0xffffu - indices[i]) << 16 | place);
        }
    }
    if (mCandidates.size() > mKept) {
        std::nth_element(mCandidates.begin(), mCandidates.begin() + std::ptrdiff_t(mKept), mCandidates.end(),
                         std::greater<>());
        mCandidates.resize(mKept);
    }
    mSelected.clear();
    for (uint64_t candidate : mCandidates) mSelected.push_back(uint32_t(candidate) ^ 0xffff0000u);
    std::ranges::sort(mSelected);
}

void CpuRowPacker::pack(const CpuCoefficients& coefficients, CpuRows& rows) {
    rows.counts.clear(), rows.scales.clear(), rows.indices.clear(), rows.values.clear();
    rows.losses = {};
    for (int term = 0; term < mTransport.terms(); term++) {
        const int group = term / coefficients.lanes, lane = term % coefficients.lanes;
        select(coefficients, group, lane);
        float scale = 0;
        for (uint32_t entry : mSelected) {
            const vec3 magnitude = glm::abs(coefficientAt(coefficients, group, lane, entry & 0xffff));
            scale = std::max({scale, magnitude.x, magnitude.y, magnitude.z});
        }
        const vec3 step = scale / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum);
        const size_t before = rows.values.size();
        double kept = 0;
        for (uint32_t entry : mSelected) {
            const vec3 value = coefficientAt(coefficients, group, lane, entry & 0xffff);
            const ivec3 quantized = quantizeCoefficient(value, scale);
            const vec3 lost = value - vec3(quantized) * step;
            kept += double(keyOf(value));
            rows.losses.quantized += double(keyOf(lost));
            if (quantized == ivec3(0)) continue;
            rows.indices.push_back(uint16_t(entry >> 16));
            rows.values.push_back(packCoefficient(quantized));
        }
        const double total = coefficients.energy[size_t(term)];
        rows.losses.total += total;
        rows.losses.dropped += std::max(0.0, total - kept);
        rows.counts.push_back(uint32_t(rows.values.size() - before));
        rows.scales.push_back(scale);
    }
}

} // namespace relume

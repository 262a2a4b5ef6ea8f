#include "precompute/cpu/cpu_transport.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"
#include "precompute/cpu/cpu_visibility.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace relume {

namespace {

constexpr int kBlock = CpuCoefficients::kBlock;

// Returns `count` bits of the curve from `first` on. `count` is a power of two up to 64, `first` a multiple
// of it.
uint64_t bitsAt(std::span<const uint64_t> bits, size_t first, int count) {
    const uint64_t word = bits[first / 64] >> (first % 64);
    return count == 64 ? word : word & ((uint64_t(1) << count) - 1);
}

bool isAnySet(std::span<const uint64_t> bits, size_t first, int count) {
    if (count <= 64) return bitsAt(bits, first, count) != 0;
    return std::ranges::any_of(bits.subspan(first / 64, size_t(count) / 64),
                               [](uint64_t word) { return word != 0; });
}

// Texels and weights of 16 light map lookups: bilinear weights times cosine, solid angle and visible
// fraction.
struct Lookups {
    alignas(64) int texels[4][kBlock];
    alignas(64) float weights[4][kBlock];
};

struct Locals {
    alignas(64) float x[kBlock], y[kBlock], z[kBlock];
};

// Vectorized diskMapCoordinates() and placeInMap(), 16 at a time.
void findPlaces(DiskMapping mapping, int size, const Locals& local, const float* weight, Lookups& lookups) {
    if (isPolar(mapping)) { // vectorizing its arc tangents does not pay
        for (int i = 0; i < kBlock; i++) {
            if (!(weight[i] > 0)) {
                for (int corner = 0; corner < 4; corner++) lookups.weights[corner][i] = 0;
                continue;
            }
            const MapPlace place = placeInMap(size, mapping, {local.x[i], local.y[i], local.z[i]});
            const vec2 w = place.weight;
            const float corners[4] = {(1 - w.x) * (1 - w.y), w.x * (1 - w.y), (1 - w.x) * w.y, w.x * w.y};
            for (int corner = 0; corner < 4; corner++) {
                lookups.texels[corner][i] = place.texels[size_t(corner)];
                lookups.weights[corner][i] = corners[corner] * weight[i];
            }
        }
        return;
    }
    const bool isEqualArea = mapping == DiskMapping::EqualArea;
    const auto side = float(size);
    for (int i = 0; i < kBlock; i++) {
        const float above = local.z[i] > 0 ? local.z[i] : 0;
        const float scale = isEqualArea ? 0.5f / std::sqrt(1.0f + above) : 0.5f;
        const float x = (scale * local.x[i] + 0.5f) * side - 0.5f;
        const float y = (scale * local.y[i] + 0.5f) * side - 0.5f;
        const float left = std::floor(x), top = std::floor(y);
        const float u = x - left, v = y - top;
        const int x0 = std::min(std::max(int(left), 0), size - 1);
        const int x1 = std::min(std::max(int(left) + 1, 0), size - 1);
        const int y0 = std::min(std::max(int(top), 0), size - 1);
        const int y1 = std::min(std::max(int(top) + 1, 0), size - 1);
        lookups.texels[0][i] = y0 * size + x0;
        lookups.texels[1][i] = y0 * size + x1;
        lookups.texels[2][i] = y1 * size + x0;
        lookups.texels[3][i] = y1 * size + x1;
        const float upper = (1 - v) * weight[i], lower = v * weight[i];
        lookups.weights[0][i] = (1 - u) * upper;
        lookups.weights[1][i] = u * upper;
        lookups.weights[2][i] = (1 - u) * lower;
        lookups.weights[3][i] = u * lower;
    }
}

// Adds lookup `i` to a texel of one group.
template <int Stride>
void addLookup(const float* map, const Lookups& lookups, int i, float* texel) {
    const float* a = map + lookups.texels[0][i] * Stride;
    const float* b = map + lookups.texels[1][i] * Stride;
    const float* c = map + lookups.texels[2][i] * Stride;
    const float* d = map + lookups.texels[3][i] * Stride;
    const float wa = lookups.weights[0][i], wb = lookups.weights[1][i];
    const float wc = lookups.weights[2][i], wd = lookups.weights[3][i];
    for (int j = 0; j < Stride; j++) texel[j] += (wa * a[j] + wb * b[j]) + (wc * c[j] + wd * d[j]);
}

// Applies one Haar step to four neighbors on the curve, as haarForward() does: three details and the average.
template <int Stride>
void haarStep(const float* quad, float* details, float* average) {
    float copy[4 * Stride]; // details may overlap the quad
    std::copy_n(quad, 4 * Stride, copy);
    for (int j = 0; j < Stride; j++) {
        const float a = copy[j], b = copy[Stride + j], c = copy[2 * Stride + j], d = copy[3 * Stride + j];
        average[j] = 0.5f * (a + b + c + d);
        details[j] = 0.5f * (a - b + c - d);
        details[Stride + j] = 0.5f * (a + b - c - d);
        details[2 * Stride + j] = 0.5f * (a - b - c + d);
    }
}

// Computes the maximum and the sum of each lane's keys over a block.
template <int Stride>
void measure(const float* values, float* maxima, double* energy) {
    constexpr int kLanes = Stride == 4 ? 1 : 4;
    float largest[kLanes] = {}, sum[kLanes] = {};
    for (int i = 0; i < kBlock; i++, values += Stride)
        for (int lane = 0; lane < kLanes; lane++) {
            const float r = values[lane], g = values[kLanes + lane], b = values[2 * kLanes + lane];
            const float key = r * r + g * g + b * b;
            largest[lane] = key > largest[lane] ? key : largest[lane];
            sum[lane] += key;
        }
    for (int lane = 0; lane < kLanes; lane++) {
        maxima[lane] = largest[lane];
        energy[lane] += double(sum[lane]);
    }
}

} // namespace

CpuTransport::CpuTransport(std::span<const FactoredBrdf* const> brdfs, int faceSize, int visibilitySize,
                           int samples)
    : mSamples(samples) {
    RELUME_CHECK(!brdfs.empty());
    RELUME_CHECK(faceSize >= 16 && std::has_single_bit(unsigned(faceSize)));
    const int cells = int(std::lround(std::sqrt(double(samples)))); // cells per side of a lighting texel
    const int cellSide = visibilitySize / (faceSize * cells);
    RELUME_CHECK_EQ(cells * cells, samples);
    RELUME_CHECK(cellSide >= 1 && cellSide <= 8 && cellSide * faceSize * cells == visibilitySize);
    mCellTexels = cellSide * cellSide;
    mMapSize = brdfs.front()->size;
    mMapping = brdfs.front()->mapping;
    for (const FactoredBrdf* brdf : brdfs) {
        RELUME_CHECK(brdf->size == mMapSize && brdf->mapping == mMapping);
        mTerms += brdf->terms;
    }

    const size_t mapTexels = brdfs.front()->mapTexels();
    const int lanes = groupLanes(mTerms), stride = groupStride(mTerms);
    const int groups = (mTerms + lanes - 1) / lanes;
    mMaps.resize(size_t(groups) * mapTexels * size_t(stride), 0);
    int term = 0;
    for (const FactoredBrdf* brdf : brdfs)
        for (int k = 0; k < brdf->terms; k++, term++)
            for (size_t texel = 0; texel < mapTexels; texel++)
                for (int channel = 0; channel < 3; channel++)
                    mMaps[(size_t(term / lanes) * mapTexels + texel) * size_t(stride) +
                          size_t(channel * lanes + term % lanes)] = brdf->lightMap(k)[texel][channel];

    const int evaluationSize = faceSize * cells;
    for (int face = 0; face < kCubeFaces; face++)
        for (uint32_t i = 0; i < uint32_t(evaluationSize * evaluationSize); i++) {
            const ivec2 place = mortonPlace(i);
            const vec3 direction = cubeTexelDirection(face, place.x, place.y, evaluationSize);
            mX.push_back(direction.x), mY.push_back(direction.y), mZ.push_back(direction.z);
            mSolidAngle.push_back(cubeTexelSolidAngle(place.x, place.y, evaluationSize) / float(mCellTexels));
        }

    const auto indexOf = [&](int face, ivec2 place) {
        return uint16_t(cubeTexelIndex(face, place.x, place.y, faceSize));
    };
    for (int side = faceSize; side > 1; side = std::max(side / 4, 1)) {
        const bool isSingleLevel = side == 2;
        const int blocksSide = std::max(side / 4, 1);
        const auto faceBlocks = uint32_t(blocksSide * blocksSide);
        mRounds.push_back({kCubeFaces * faceBlocks, uint32_t(mIndices.size()), isSingleLevel});
        for (int face = 0; face < kCubeFaces; face++)
            for (uint32_t block = 0; block < faceBlocks; block++) {
                BlockIndices indices{};
                const auto setDetails = [&](size_t first, ivec2 place, int half) {
                    indices[first] = indexOf(face, place + ivec2(half, 0));
                    indices[first + 1] = indexOf(face, place + ivec2(0, half));
                    indices[first + 2] = indexOf(face, place + ivec2(half, half));
                };
                if (!isSingleLevel)
                    for (uint32_t quad = 0; quad < 4; quad++)
                        setDetails(3 * quad, mortonPlace(4 * block + quad), side / 2);
                setDetails(12, mortonPlace(block), blocksSide);
                indices[15] = indexOf(face, {0, 0});
                mIndices.push_back(indices);
            }
    }
}

CpuCoefficients CpuTransport::makeWorkspace() const {
    CpuCoefficients workspace;
    workspace.lanes = groupLanes(mTerms);
    workspace.stride = groupStride(mTerms);
    workspace.groups = (mTerms + workspace.lanes - 1) / workspace.lanes;
    workspace.capacity = mIndices.size();
    const size_t blocks = size_t(workspace.groups) * workspace.capacity;
    workspace.blocks.reserve(workspace.capacity);
    workspace.values.resize(blocks * kBlock * size_t(workspace.stride));
    workspace.maxima.resize(blocks * size_t(workspace.lanes));
    workspace.energy.resize(size_t(workspace.groups * workspace.lanes));
    for (const Round& round : mRounds)
        workspace.averages.emplace_back(size_t(round.blocks) * size_t(workspace.stride));
    return workspace;
}

void CpuTransport::evaluate(const TangentFrame& frame, std::span<const uint64_t> bits,
                            CpuCoefficients& result) const {
    if (result.stride == 4)
        evaluateBlocks<4>(frame, bits, result);
    else
        evaluateBlocks<12>(frame, bits, result);
}

void CpuTransport::transform(CpuCoefficients& result) const {
    if (result.stride == 4)
        transformBlocks<4>(result);
    else
        transformBlocks<12>(result);
}

template <int Stride>
void CpuTransport::evaluateBlocks(const TangentFrame& frame, std::span<const uint64_t> bits,
                                  CpuCoefficients& result) const {
    const size_t mapTexels = size_t(mMapSize) * size_t(mMapSize);
    result.blocks.clear();
    for (uint32_t block = 0; block < mRounds.front().blocks; block++) {
        const size_t firstEvaluation = size_t(block) * kBlock * size_t(mSamples);
        const int blockTexels = kBlock * mSamples * mCellTexels;
        if (!isAnySet(bits, size_t(block) * size_t(blockTexels), blockTexels)) continue;
        for (int group = 0; group < result.groups; group++)
            std::fill_n(result.block(group, result.blocks.size()), kBlock * Stride, 0.0f);
        for (int part = 0; part < mSamples; part++) {
            const size_t first = firstEvaluation + size_t(part * kBlock);
            alignas(64) int counts[kBlock];
            for (int i = 0; i < kBlock; i++)
                counts[i] =
                    std::popcount(bitsAt(bits, (first + size_t(i)) * size_t(mCellTexels), mCellTexels));
            Locals local;
            alignas(64) float weights[kBlock];
            for (int i = 0; i < kBlock; i++) {
                const float x = mX[first + size_t(i)], y = mY[first + size_t(i)], z = mZ[first + size_t(i)];
                local.x[i] = x * frame.s.x + y * frame.s.y + z * frame.s.z;
                local.y[i] = x * frame.t.x + y * frame.t.y + z * frame.t.z;
                local.z[i] = x * frame.n.x + y * frame.n.y + z * frame.n.z;
                const float cosine = local.z[i] > 0 ? local.z[i] : 0;
                weights[i] = cosine * mSolidAngle[first + size_t(i)] * float(counts[i]);
            }
            Lookups lookups;
            findPlaces(mMapping, mMapSize, local, weights, lookups);
            for (int group = 0; group < result.groups; group++) {
                const float* map = &mMaps[size_t(group) * mapTexels * Stride];
                float* texels = result.block(group, result.blocks.size());
                for (int i = 0; i < kBlock; i++)
                    if (weights[i] > 0)
                        addLookup<Stride>(map, lookups, i, texels + (part * kBlock + i) / mSamples * Stride);
            }
        }
        result.blocks.push_back(block);
    }
}

template <int Stride>
void CpuTransport::transformBlocks(CpuCoefficients& result) const {
    constexpr int kLanes = Stride == 4 ? 1 : 4;
    const size_t seen = result.blocks.size();
    for (size_t round = 1; round < mRounds.size(); round++)
        for (uint32_t block = 0; block < mRounds[round].blocks; block++)
            result.blocks.push_back(mRounds[round].firstBlock + block);
    for (int group = 0; group < result.groups; group++) {
        double* energy = &result.energy[size_t(group * kLanes)];
        std::fill_n(energy, kLanes, 0.0);
        const auto finish = [&](size_t block) {
            measure<Stride>(result.block(group, block),
                            &result.maxima[(size_t(group) * result.capacity + block) * kLanes], energy);
        };
        // Transforms two levels of a block; its average goes to `average`.
        const auto twoLevels = [&](float* values, float* average) {
            float quads[4 * Stride];
            for (int quad = 0; quad < 4; quad++)
                haarStep<Stride>(values + 4 * quad * Stride, values + 3 * quad * Stride,
                                 quads + quad * Stride);
            haarStep<Stride>(quads, values + 12 * Stride, average);
            std::fill_n(values + 15 * Stride, Stride, 0.0f);
        };
        std::ranges::fill(result.averages.front(), 0.0f);
        for (size_t block = 0; block < seen; block++) {
            twoLevels(result.block(group, block),
                      &result.averages.front()[size_t(result.blocks[block]) * Stride]);
            finish(block);
        }
        size_t block = seen;
        for (size_t round = 1; round < mRounds.size(); round++) {
            const float* input = result.averages[round - 1].data();
            const bool isLast = round + 1 == mRounds.size();
            for (uint32_t i = 0; i < mRounds[round].blocks; i++, block++) {
                float* values = result.block(group, block);
                float* average = &result.averages[round][i * Stride];
                if (mRounds[round].isSingleLevel) {
                    std::fill_n(values, 12 * Stride, 0.0f);
                    haarStep<Stride>(input + i * 4 * Stride, values + 12 * Stride, average);
                } else {
                    std::copy_n(input + i * kBlock * Stride, kBlock * Stride, values);
                    twoLevels(values, average);
                }
                std::copy_n(average, Stride, values + 15 * Stride);
                if (!isLast) std::fill_n(values + 15 * Stride, Stride, 0.0f);
                finish(block);
            }
        }
    }
}

} // namespace relume

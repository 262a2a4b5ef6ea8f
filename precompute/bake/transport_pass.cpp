#include "precompute/bake/transport_pass.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"
#include "shaders/shared/bake.h"
#include "shaders/transport_comp.h"
#include "shaders/transport_portable_comp.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <thread>

namespace relume {

namespace {

// Makes a table for lookups of one fetch per channel: texel ((y · (S + 1) + x) · K + term) · 3 + channel
// holds the four values that a lookup between the map's texels x - 1 and x, y - 1 and y needs. Borders are
// clamped, or wrap around.
vk::Buffer makeCorners(const vk::Device& device, const FactoredBrdf& brdf) {
    const auto column = [&](int x) {
        return isPolar(brdf.mapping) ? (x + brdf.size) % brdf.size : std::clamp(x, 0, brdf.size - 1);
    };
    std::vector<vec4> texels;
    texels.reserve(size_t(brdf.terms) * 3 * size_t(brdf.size + 1) * size_t(brdf.size + 1));
    for (int y = 0; y <= brdf.size; y++)
        for (int x = 0; x <= brdf.size; x++)
            for (int term = 0; term < brdf.terms; term++) {
                const vec3* above = brdf.lightMap(term) + std::max(y - 1, 0) * brdf.size;
                const vec3* below = brdf.lightMap(term) + std::min(y, brdf.size - 1) * brdf.size;
                for (int channel = 0; channel < 3; channel++)
                    texels.emplace_back(above[column(x - 1)][channel], above[column(x)][channel],
                                        below[column(x - 1)][channel], below[column(x)][channel]);
            }
    if (texels.size() > device.mostTexels(sizeof(vec4)))
        throw Error(fmt::format(
            "light maps: {} texels are more than the {} that {} allows in a buffer; use fewer terms or "
            "smaller maps",
            texels.size(), device.mostTexels(sizeof(vec4)), device.name()));
    return vk::upload<vec4>(device, texels, "light map corners");
}

} // namespace

TransportTuning TransportTuning::of(const vk::Device& device) {
    if (!device.info().isSoftware) return {64, ~0ull};
    // A workgroup of one subgroup avoids switching between subgroups. Rows that are read soon after they were
    // written come from the cache.
    return {std::min(64u, device.info().subgroupSize),
            uint64_t(std::max(1u, std::thread::hardware_concurrency())) << 21};
}

uint64_t TransportPass::bytesPerPoint(int terms, uint64_t entries, const BakeOptions& options) {
    // Coefficients and block summaries; selected indices, values, and entries read back.
    return uint64_t(terms) * (PackingPass::coefficientBytes(options.faceSize) +
                              PackingPass::summaryBytes(options.faceSize)) +
           16 * entries;
}

uint32_t TransportPass::largestBatch(const vk::Device& device, const BakeOptions& options) {
    return uint32_t(device.largestStorageBuffer() / PackingPass::coefficientBytes(options.faceSize));
}

TransportPass::TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                             uint32_t capacity, const TransportTuning& tuning) {
    const uint32_t largestBatch = TransportPass::largestBatch(device, options);
    RELUME_CHECK_LE(capacity, largestBatch);
    const auto terms = uint32_t(brdf.terms);
    const uint32_t termsTogether = std::min(terms, largestBatch / capacity);
    for (uint32_t term = 0; term < terms; term += termsTogether) {
        const uint32_t count = std::min(termsTogether, terms - term);
        mGroups.push_back({term, count, {device, uint64_t(capacity) * count, options.coefficients}});
    }
    const uint64_t pointBytes = termsTogether * PackingPass::coefficientBytes(options.faceSize);
    mTogether = uint32_t(std::clamp<uint64_t>(tuning.coefficientBytes / pointBytes, 1, capacity));
    mPacking.emplace(device, options.faceSize, options.coefficients, uint64_t(capacity) * termsTogether,
                     uint64_t(mTogether) * termsTogether, tuning.lanes);
    mCorners = makeCorners(device, brdf);
    mTerms = terms;
    mMapSize = uint32_t(brdf.size);
    const auto samplesPerSide = uint32_t(std::lround(std::sqrt(options.transportSamples)));
    // Programs are made for few capacities, since each takes seconds to compile on a software device.
    const uint32_t termCapacity = termsTogether == 1 ? 1 : std::max(8u, std::bit_ceil(termsTogether));
    mTransport = {device,
                  transport_comp_spirv,
                  {uint32_t(options.faceSize), uint32_t(options.visibilitySize), samplesPerSide,
                   uint32_t(brdf.mapping), termCapacity, tuning.lanes},
                  "transport"};
}

std::vector<std::span<const uint32_t>> TransportPass::kernels() {
    std::vector<std::span<const uint32_t>> all = PackingPass::kernels();
    all.insert(all.begin(), {transport_comp_spirv, transport_portable_comp_spirv});
    return all;
}

void TransportPass::record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                           const vk::Buffer& bits) const {
    for (const TermGroup& group : mGroups) recordGroup(commands, group, points, count, bits);
    commands.barrier(vk::Stage::Compute, vk::Stage::Host);
}

void TransportPass::recordGroup(vk::Commands& commands, const TermGroup& group, const vk::Buffer& points,
                                uint32_t count, const vk::Buffer& bits) const {
    using enum vk::Stage;
    for (uint32_t first = 0; first < count; first += mTogether) {
        const uint32_t pointCount = std::min(mTogether, count - first);
        commands.barrier(Compute, Compute);
        commands.pass("transport", [&] {
            commands.dispatch(mTransport,
                              {points, bits, vk::Binding::texelsOf(mCorners, VK_FORMAT_R32G32B32A32_SFLOAT),
                               mPacking->coefficients(), mPacking->summaries()},
                              shared::TransportPush{group.firstTerm, group.terms, first, mTerms, mMapSize},
                              {6 * mTransport.groupSize()[0], pointCount, 1});
        });
        mPacking->recordSelection(commands, group.rows, pointCount * group.terms, first * group.terms);
    }
    mPacking->recordCompaction(commands, group.rows, count * group.terms);
}

void TransportPass::collect(uint32_t count, SparseTransport& transport,
                            std::vector<TransportLosses>& losses) const {
    // Rows are read back group by group, by point in each; the asset orders them by point over all terms.
    std::vector<uint64_t> next(mGroups.size(), 0);
    for (uint32_t point = 0; point < count; point++)
        for (size_t g = 0; g < mGroups.size(); g++) {
            const TermGroup& group = mGroups[g];
            for (uint32_t row = point * group.terms; row < (point + 1) * group.terms; row++)
                group.rows.append(row, next[g], transport, losses);
        }
}

} // namespace relume

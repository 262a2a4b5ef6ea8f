#include "precompute/bake/transport_pass.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"
#include "shaders/compact_comp.h"
#include "shaders/quantize_comp.h"
#include "shaders/row_starts_comp.h"
#include "shaders/select_comp.h"
#include "shaders/transport_comp.h"
#include "shaders/transport_portable_comp.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <thread>

namespace relume {

namespace {

// Returns the number of blocks of a row, as laid out in shaders/lib/haar_block.glsl.
uint64_t rowBlocks(uint64_t faceSize) {
    const uint64_t fine = faceSize / 4, coarse = faceSize / 16;
    return 6 * (fine * fine + coarse * coarse + 1);
}

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

uint64_t TransportPass::rowBytes(const BakeOptions& options) {
    return rowBlocks(uint64_t(options.faceSize)) * 16 * sizeof(vec3);
}

TransportTuning TransportTuning::of(const vk::Device& device) {
    if (!device.info().isSoftware) return {64, ~0ull};
    // A workgroup of one subgroup avoids switching between subgroups. Rows that are read soon after they were
    // written come from the cache.
    return {std::min(64u, device.info().subgroupSize),
            uint64_t(std::max(1u, std::thread::hardware_concurrency())) << 21};
}

uint64_t TransportPass::bytesPerPoint(int terms, const BakeOptions& options) {
    const auto entries = uint64_t(options.coefficients);
    // Coefficients and block summaries; selected indices, values, and entries read back.
    return uint64_t(terms) *
           (rowBytes(options) + rowBlocks(uint64_t(options.faceSize)) * sizeof(vec2) + 16 * entries);
}

uint32_t TransportPass::largestBatch(const vk::Device& device, const BakeOptions& options) {
    return uint32_t(device.largestStorageBuffer() / rowBytes(options));
}

TransportPass::TransportPass(const vk::Device& device, const FactoredBrdf& brdf, const BakeOptions& options,
                             uint32_t capacity, const TransportTuning& tuning)
    : mFaceSize(uint32_t(options.faceSize)), mKept(uint32_t(options.coefficients)) {
    using enum vk::BufferUse;
    const uint32_t largestBatch = TransportPass::largestBatch(device, options);
    RELUME_CHECK_LE(capacity, largestBatch);
    const auto terms = uint32_t(brdf.terms);
    const uint32_t termsTogether = std::min(terms, largestBatch / capacity);
    for (uint32_t term = 0; term < terms; term += termsTogether) {
        const uint32_t count = std::min(termsTogether, terms - term);
        const uint64_t rows = uint64_t(capacity) * count;
        mGroups.push_back({term,
                           count,
                           {device, rows * 4, Readback, "row counts"},
                           {device, rows * 4, Readback, "row scales"},
                           {device, rows * sizeof(shared::RowStatistics), Readback, "row statistics"},
                           {device, rows * mKept * 8, Readback, "row entries"}});
    }
    const uint64_t rows = uint64_t(capacity) * termsTogether;
    mTogether = uint32_t(
        std::clamp<uint64_t>(tuning.coefficientBytes / (termsTogether * rowBytes(options)), 1, capacity));
    const uint64_t rowsTogether = uint64_t(mTogether) * termsTogether;
    mCoefficients = {device, rowsTogether * rowBytes(options), Device, "coefficients"};
    mSelected = {device, rows * mKept * 4, Device, "selected indices"};
    mSelectedCounts = {device, rows * 4, Device, "selected counts"};
    mValues = {device, rows * mKept * 4, Device, "packed values"};
    mStarts = {device, rows * 4, Device, "row starts"};

    mSummaries = {device, rowsTogether * rowBlocks(mFaceSize) * sizeof(vec2), Device, "block summaries"};

    mCorners = makeCorners(device, brdf);
    const auto samplesPerSide = uint32_t(std::lround(std::sqrt(options.transportSamples)));
    mTransport = {device,
                  transport_comp_spirv,
                  {mFaceSize, uint32_t(options.visibilitySize), samplesPerSide, uint32_t(brdf.size),
                   uint32_t(brdf.mapping), terms, tuning.lanes},
                  "transport"};
    mSelect = {device, select_comp_spirv, {mFaceSize, tuning.lanes}, "select"};
    mQuantize = {device, quantize_comp_spirv, {mFaceSize}, "quantize"};
    mRowStarts = {device, row_starts_comp_spirv, {}, "row starts"};
    mCompact = {device, compact_comp_spirv, {}, "compact"};
}

std::vector<std::span<const uint32_t>> TransportPass::kernels() {
    return {transport_comp_spirv, transport_portable_comp_spirv, select_comp_spirv,
            quantize_comp_spirv,  row_starts_comp_spirv,         compact_comp_spirv};
}

void TransportPass::record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                           const vk::Buffer& bits) const {
    for (const TermGroup& group : mGroups) recordGroup(commands, group, points, count, bits);
    commands.barrier(vk::Stage::Compute, vk::Stage::Host);
}

void TransportPass::recordGroup(vk::Commands& commands, const TermGroup& group, const vk::Buffer& points,
                                uint32_t count, const vk::Buffer& bits) const {
    using enum vk::Stage;
    const auto groupPerRow = [&](const vk::ComputeProgram& program, uint32_t rowCount) {
        return uvec3(rowCount * program.groupSize()[0], 1, 1);
    };
    for (uint32_t first = 0; first < count; first += mTogether) {
        const uint32_t pointCount = std::min(mTogether, count - first), rowCount = pointCount * group.terms;
        const shared::RowsPush rows{rowCount, mKept, first * group.terms};
        commands.barrier(Compute, Compute);
        commands.pass("transport", [&] {
            commands.dispatch(mTransport,
                              {points, bits, vk::Binding::texelsOf(mCorners, VK_FORMAT_R32G32B32A32_SFLOAT),
                               mCoefficients, mSummaries},
                              shared::TransportPush{group.firstTerm, group.terms, first},
                              {6 * mTransport.groupSize()[0], pointCount, 1});
        });
        commands.barrier(Compute, Compute);
        commands.pass("select", [&] {
            commands.dispatch(mSelect,
                              {mCoefficients, mSummaries, mSelected, mSelectedCounts, group.statistics}, rows,
                              groupPerRow(mSelect, rowCount));
        });
        commands.barrier(Compute, Compute);
        commands.pass("quantize", [&] {
            commands.dispatch(mQuantize,
                              {mCoefficients, mSelected, mSelectedCounts, mValues, group.counts, group.scales,
                               group.statistics},
                              rows, groupPerRow(mQuantize, rowCount));
        });
    }
    const shared::RowsPush rows{count * group.terms, mKept, 0};
    commands.barrier(Compute, Compute);
    commands.pass("compact", [&] {
        commands.dispatch(mRowStarts, {group.counts, mStarts}, rows, {mRowStarts.groupSize()[0], 1, 1});
        commands.barrier(Compute, Compute);
        commands.dispatch(mCompact, {mSelected, mSelectedCounts, mValues, mStarts, group.entries}, rows,
                          groupPerRow(mCompact, rows.rows));
    });
}

void TransportPass::collect(uint32_t count, SparseTransport& transport,
                            std::vector<TransportLosses>& losses) const {
    // Rows are read back group by group, by point in each; the asset orders them by point over all terms.
    std::vector<uint64_t> next(mGroups.size(), 0);
    for (uint32_t point = 0; point < count; point++)
        for (size_t g = 0; g < mGroups.size(); g++) {
            const TermGroup& group = mGroups[g];
            const auto entries = group.entries.map<glm::u32vec2>();
            for (uint32_t row = point * group.terms; row < (point + 1) * group.terms; row++) {
                const uint32_t rowEntries = group.counts.map<uint32_t>()[row];
                for (const glm::u32vec2& entry : entries.subspan(next[g], rowEntries)) {
                    transport.indices.push_back(uint16_t(entry.x));
                    transport.values.push_back(entry.y);
                }
                next[g] += rowEntries;
                transport.rowStarts.push_back(transport.values.size());
                transport.scales.push_back(group.scales.map<float>()[row]);
                const shared::RowStatistics& sums = group.statistics.map<shared::RowStatistics>()[row];
                losses.push_back({sums.total, sums.dropped, sums.quantized});
            }
        }
}

} // namespace relume

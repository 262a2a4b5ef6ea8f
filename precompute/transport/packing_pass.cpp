#include "precompute/transport/packing_pass.h"

#include "shaders/compact_comp.h"
#include "shaders/quantize_comp.h"
#include "shaders/row_starts_comp.h"
#include "shaders/select_comp.h"
#include "shaders/shared/bake.h"

namespace relume {

namespace {

// Returns the number of blocks of a row, as laid out in shaders/lib/haar_block.glsl.
uint64_t rowBlocks(int faceSize) {
    const uint64_t fine = uint64_t(faceSize) / 4, coarse = uint64_t(faceSize) / 16;
    return 6 * (fine * fine + coarse * coarse + 1);
}

uvec3 groupPerRow(const vk::ComputeProgram& program, uint32_t rows) {
    return {rows * program.groupSize()[0], 1, 1};
}

} // namespace

PackedRows::PackedRows(const vk::Device& device, uint64_t rows, int kept)
    : counts(device, rows * 4, vk::BufferUse::Readback, "row counts"),
      scales(device, rows * 4, vk::BufferUse::Readback, "row scales"),
      statistics(device, rows * sizeof(shared::RowStatistics), vk::BufferUse::Readback, "row statistics"),
      entries(device, rows * uint64_t(kept) * 8, vk::BufferUse::Readback, "row entries") {}

void PackedRows::append(uint32_t row, uint64_t& firstEntry, SparseTransport& transport,
                        std::vector<TransportLosses>& losses) const {
    const uint32_t count = counts.map<uint32_t>()[row];
    for (const glm::u32vec2& entry : entries.map<glm::u32vec2>().subspan(firstEntry, count)) {
        transport.indices.push_back(uint16_t(entry.x));
        transport.values.push_back(entry.y);
    }
    firstEntry += count;
    transport.rowStarts.push_back(transport.values.size());
    transport.scales.push_back(scales.map<float>()[row]);
    const shared::RowStatistics& sums = statistics.map<shared::RowStatistics>()[row];
    losses.push_back({sums.total, sums.dropped, sums.quantized});
}

uint64_t PackingPass::coefficientBytes(int faceSize) { return rowBlocks(faceSize) * 16 * sizeof(vec3); }

uint64_t PackingPass::summaryBytes(int faceSize) { return rowBlocks(faceSize) * sizeof(vec2); }

PackingPass::PackingPass(const vk::Device& device, int faceSize, int kept, uint64_t rows,
                         uint64_t rowsTogether, uint32_t lanes)
    : mKept(uint32_t(kept)) {
    using enum vk::BufferUse;
    mCoefficients = {device, rowsTogether * coefficientBytes(faceSize), Device, "coefficients"};
    mSelected = {device, rows * mKept * 4, Device, "selected indices"};
    mSelectedCounts = {device, rows * 4, Device, "selected counts"};
    mValues = {device, rows * mKept * 4, Device, "packed values"};
    mStarts = {device, rows * 4, Device, "row starts"};
    mSummaries = {device, rowsTogether * summaryBytes(faceSize), Device, "block summaries"};
    mSelect = {device, select_comp_spirv, {uint32_t(faceSize), lanes}, "select"};
    mQuantize = {device, quantize_comp_spirv, {uint32_t(faceSize)}, "quantize"};
    mRowStarts = {device, row_starts_comp_spirv, {}, "row starts"};
    mCompact = {device, compact_comp_spirv, {}, "compact"};
}

std::vector<std::span<const uint32_t>> PackingPass::kernels() {
    return {select_comp_spirv, quantize_comp_spirv, row_starts_comp_spirv, compact_comp_spirv};
}

void PackingPass::recordSelection(vk::Commands& commands, const PackedRows& packed, uint32_t rows,
                                  uint32_t firstRow) const {
    using enum vk::Stage;
    const shared::RowsPush push{rows, mKept, firstRow};
    commands.barrier(Compute, Compute);
    commands.pass("select", [&] {
        commands.dispatch(mSelect, {mCoefficients, mSummaries, mSelected, mSelectedCounts, packed.statistics},
                          push, groupPerRow(mSelect, rows));
    });
    commands.barrier(Compute, Compute);
    commands.pass("quantize", [&] {
        commands.dispatch(mQuantize,
                          {mCoefficients, mSelected, mSelectedCounts, mValues, packed.counts, packed.scales,
                           packed.statistics},
                          push, groupPerRow(mQuantize, rows));
    });
}

void PackingPass::recordCompaction(vk::Commands& commands, const PackedRows& packed, uint32_t rows) const {
    using enum vk::Stage;
    const shared::RowsPush push{rows, mKept, 0};
    commands.barrier(Compute, Compute);
    commands.pass("compact", [&] {
        commands.dispatch(mRowStarts, {packed.counts, mStarts}, push, {mRowStarts.groupSize()[0], 1, 1});
        commands.barrier(Compute, Compute);
        commands.dispatch(mCompact, {mSelected, mSelectedCounts, mValues, mStarts, packed.entries}, push,
                          groupPerRow(mCompact, rows));
    });
}

} // namespace relume

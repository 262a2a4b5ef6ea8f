#include "engine/transport/rows/rows_relighter.h"

#include "engine/base/check.h"
#include "engine/vk/upload.h"
#include "shaders/relight_rows_comp.h"
#include "shaders/shared/render.h"

#include <algorithm>
#include <limits>

namespace relume {

namespace {

constexpr uint64_t kEntriesPerGroup = 8;
constexpr uint64_t kWordsPerRowGroup = 12;
constexpr uint64_t kGroupBytes = kWordsPerRowGroup * sizeof(uint32_t);

struct ShardData {
    std::vector<uint32_t> starts{0};
    std::vector<uint32_t> words;
};

uint64_t rowGroups(const SparseTransport& transport, size_t row) {
    const uint64_t entries = transport.rowStarts[row + 1] - transport.rowStarts[row];
    return (entries + kEntriesPerGroup - 1) / kEntriesPerGroup;
}

void appendRow(ShardData& shard, const SparseTransport& transport, size_t row, uint32_t coefficients) {
    const size_t firstWord = shard.words.size();
    shard.words.resize(firstWord + rowGroups(transport, row) * kWordsPerRowGroup, 0);
    const uint64_t start = transport.rowStarts[row], end = transport.rowStarts[row + 1];
    for (uint64_t entry = start; entry < end; entry++) {
        const uint64_t place = (entry - start) % kEntriesPerGroup;
        uint32_t* group = &shard.words[firstWord + (entry - start) / kEntriesPerGroup * kWordsPerRowGroup];
        RELUME_CHECK_LT(uint32_t(transport.indices[entry]), coefficients);
        group[place / 2] |= uint32_t(transport.indices[entry]) << (place % 2 * 16);
        group[4 + place] = transport.values[entry];
    }
    shard.starts.push_back(uint32_t(shard.words.size() / kWordsPerRowGroup));
}

// Returns the most rows of a shard: limited by one dispatch and by the size of the starts' buffer.
uint32_t largestRowCount(const vk::Device& device, const vk::ComputeProgram& program, uint64_t largestShard) {
    const uint64_t reached =
        uint64_t(device.limits().maxComputeWorkGroupCount[0]) * uint64_t(program.groupSize()[0]);
    const uint64_t bound = std::max<uint64_t>(largestShard / sizeof(uint32_t), 2) - 1;
    return uint32_t(std::min<uint64_t>({reached, bound, std::numeric_limits<uint32_t>::max()}));
}

} // namespace

RowsRelighter::RowsRelighter(const vk::Device& device, const SparseTransport& transport,
                             uint32_t coefficients, size_t lights, uint64_t largestShard,
                             const std::string& name)
    : SetRelighter(device, transport.rows(), lights, name),
      mRelight(device, relight_rows_comp_spirv, {}, "relight rows"),
      mScales(vk::upload<float>(device, transport.scales, name + " row scales")) {
    const uint64_t largestGroups = largestShard / kGroupBytes;
    const uint32_t largestRows = largestRowCount(device, mRelight, largestShard);
    for (uint32_t row = 0; row < rows();) {
        Shard& shard = mShards.emplace_back();
        shard.firstRow = row;
        ShardData data;
        // Every shard takes at least one row; even the longest, of all 24,576 coefficients, is far below what
        // any device binds.
        do appendRow(data, transport, row++, coefficients);
        while (row < rows() && data.starts.size() <= largestRows &&
               data.starts.back() + rowGroups(transport, row) <= largestGroups);
        shard.rows = row - shard.firstRow;
        shard.starts = vk::upload<uint32_t>(device, data.starts, name + " row starts");
        shard.entries = vk::upload<uint32_t>(device, data.words, name + " entries");
    }
}

void RowsRelighter::recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode,
                                 LightPart lit) const {
    for (const Shard& shard : mShards)
        commands.dispatch(mRelight,
                          {shard.starts, shard.entries, light.table, light.stats, mScales, tuples(lit)},
                          shared::RelightRowsPush{shard.firstRow, shard.rows}, {shard.rows, 1, 1});
}

} // namespace relume

#include "engine/render/light_table.h"

#include "engine/base/check.h"
#include "engine/vk/upload.h"
#include "shaders/light_haar_comp.h"
#include "shaders/light_quantize_comp.h"
#include "shaders/shared/render.h"

#include <atomic>
#include <bit>
#include <cmath>

namespace relume {

using vk::BufferUse;
using vk::Stage;

LightTable::LightTable(const vk::Device& device, int faceSize, const std::string& name)
    : mDevice(device), mFaceSize(faceSize), mHaarName(name + " haar"), mQuantizeName(name + " quantize") {
    RELUME_CHECK(faceSize >= 2 && std::has_single_bit(unsigned(faceSize)));
    RELUME_CHECK_LE(coefficients(), kMaximumLightEntries);
    const vk::Constants size{uint32_t(faceSize)};
    mHaarProgram = vk::ComputeProgram(device, light_haar_comp_spirv, size, "light haar");
    mQuantizeProgram = vk::ComputeProgram(device, light_quantize_comp_spirv, {}, "light quantize");
    mCoefficients =
        vk::Buffer(device, coefficients() * sizeof(vec3), BufferUse::Device, name + " coefficients");
    mTable = vk::Buffer(device, 2 * coefficients() * sizeof(shared::PackedLight), BufferUse::Device,
                        name + " table");
    mStats = vk::Buffer(device, sizeof(shared::LightStats), BufferUse::Device, name + " stats");
    mWeights = vk::Buffer(device, coefficients() * sizeof(uint32_t), BufferUse::Device, name + " weights");
}

void LightTable::record(vk::Commands& commands, const vk::Buffer& radiance, const LightSelection& selection) {
    RELUME_CHECK(selection.threshold || selection.count > 0);
    const shared::LightQuantizePush quantize{coefficients(),
                                             kLightSumLimit,
                                             uint32_t(std::countr_zero(unsigned(mFaceSize))),
                                             selection.isAreaWeighted(),
                                             selection.threshold ? 0 : uint32_t(selection.count),
                                             shareOf(selection.threshold.value_or(0))};
    static std::atomic<uint64_t> recordings = 0;
    mRecordingBefore = mRecording;
    mRecording = ++recordings;
    commands.pass(mHaarName.c_str(), [&] {
        // One workgroup per face and channel.
        commands.dispatch(mHaarProgram, {radiance, mCoefficients}, 0, {1, 6, 3});
        commands.barrier(Stage::Compute, Stage::Compute);
    });
    commands.pass(mQuantizeName.c_str(), [&] {
        commands.dispatch(mQuantizeProgram, {mCoefficients, mTable, mStats, mWeights}, quantize, {1, 1, 1});
        commands.barrier(Stage::Compute, Stage::Compute);
        commands.barrier(Stage::Compute, Stage::Draw);
    });
}

LightStats LightTable::readStats() const {
    const auto stats = vk::download<shared::LightStats>(mDevice, mStats, 1)[0];
    const bool isKnown = mRecordingBefore > 0 && stats.changed != shared::kUnknownChange;
    return {stats.scale, stats.energy > 0 ? std::sqrt(stats.lost / stats.energy) : 0, stats.kept,
            isKnown ? std::optional(stats.changed) : std::nullopt};
}

LightVector LightTable::readVector() const {
    LightVector vector;
    vector.faceSize = mFaceSize;
    const LightStats stats = readStats();
    vector.scale = stats.scale;
    vector.error = stats.error;
    const auto table = vk::download<shared::PackedLight>(mDevice, mTable, coefficients());
    for (uint32_t i = 0; i < table.size(); i++) {
        const auto& [redGreen, blue] = table[i];
        if (redGreen == 0 && blue == 0) continue;
        vector.indices.push_back(uint16_t(i));
        vector.values.push_back({int16_t(redGreen & 0xffff), int16_t(redGreen >> 16), int16_t(blue)});
    }
    return vector;
}

} // namespace relume

// The quantized light entries of a lighting cube, by which relighting multiplies transport.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/relight/set_relighter.h"
#include "engine/vk/program.h"

#include <optional>
#include <string>

namespace relume {

struct LightStats {
    float scale;                     // LightVector::scale
    float error;                     // LightVector::error
    uint32_t kept;                   // entries
    std::optional<uint32_t> changed; // entries that differ from the light recorded before; none if unknown
};

// Transforms, selects and quantizes radiance. Keeps a reference to the device, which must outlive it.
class LightTable {
  public:
    // `faceSize` is F, an even power of two up to 64. Passes begin with `name`.
    LightTable(const vk::Device& device, int faceSize, const std::string& name);

    // Records passes NAME "haar" and NAME "quantize" of 6 F² × vec3. The caller first lets those finish that
    // read the table of an earlier recording; compute and draws may use the new one at once. Submit
    // recordings once, in order: the table has the changes since the recording before.
    void record(vk::Commands& commands, const vk::Buffer& radiance, const LightSelection& selection);

    // Returns 6 F² × shared::PackedLight, zero where dropped, then as many differences from the light before.
    const vk::Buffer& table() const { return mTable; }
    const vk::Buffer& stats() const { return mStats; } // shared::LightStats

    // Return the numbers of the last record() and the one before, from 1 over all tables; 0 for none.
    uint64_t recording() const { return mRecording; }
    uint64_t recordingBefore() const { return mRecordingBefore; }
    DeviceLight onDevice() const { return {mTable, mStats, mRecording, mRecordingBefore}; }

    // Return results of the last submission of record(). Wait for the device.
    LightStats readStats() const;
    LightVector readVector() const;

  private:
    uint32_t coefficients() const { return 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize); }

    const vk::Device& mDevice;
    int mFaceSize;
    std::string mHaarName, mQuantizeName; // of the passes
    vk::ComputeProgram mHaarProgram, mQuantizeProgram;
    vk::Buffer mCoefficients; // 6 F² × vec3
    vk::Buffer mTable, mStats, mWeights;
    uint64_t mRecording = 0, mRecordingBefore = 0;
};

} // namespace relume

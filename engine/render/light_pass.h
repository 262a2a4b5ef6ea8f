// Light change, first half: a light becomes the quantized coefficients that relighting multiplies with.
// Everything stays on the device: sample → radiance → Haar → coefficients → quantize → table.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/render/light_sources.h"

#include <optional>

namespace relume {

struct LightStats {
    float scale;                     // LightVector::scale
    float error;                     // LightVector::error
    uint32_t kept;                   // entries
    std::optional<uint32_t> changed; // that differ from the light recorded before; none: not to be told
};

class LightPass {
  public:
    // `faceSize`: F of the asset, 32 or 64 (any even power of two to 64 works).
    LightPass(const vk::Device& device, int faceSize);

    // The light of the record() calls that follow. Sources are sampled anew by every record(), at most
    // kMostSources of a kind; a cube, of F texels a side, is taken as it is. Maps of environments that the
    // light before did not have are uploaded, which waits: maps are told apart by their pointers, and kept
    // until the next light.
    void setLight(Light light);
    void setEnvironment(const Environment& prepared); // alone
    void setCube(const LightCube& cube);

    // Passes "light sample" (environments), "light sky", "light strokes", "light lamps", "light distant"
    // (where there are any), "light haar", "light quantize". `rotation` in radians turns the light, as
    // turned() does, but not a cube. Compute and draws may use the results at once. Recordings are to be
    // submitted in their order, and once: the table's changes are those since the recording before.
    void record(vk::Commands& commands, float rotation = 0, const LightSelection& selection = {});

    int faceSize() const { return mFaceSize; }
    // 6 F² × shared::PackedLight, zero where dropped; then, of the same shape, how the light changed.
    const vk::Buffer& table() const { return mTable; }
    const vk::Buffer& stats() const { return mStats; }       // shared::LightStats
    const vk::Buffer& radiance() const { return mRadiance; } // 6 F² × vec3

    // Of the last record() and the one before, among those of all light passes: from 1; 0 is none.
    uint64_t recording() const { return mRecording; }
    uint64_t recordingBefore() const { return mRecordingBefore; }

    // What selection and quantization cost in the last submission of record(). Waits for the device.
    LightStats readStats() const;

    // What the last submission of record() left, for tests and `relume verify`. They wait for the device.
    LightCube readCube() const;
    LightVector readVector() const;

  private:
    uint32_t coefficients() const { return 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize); }

    const vk::Device& mDevice;
    int mFaceSize;
    vk::ComputeProgram mHaarProgram, mQuantizeProgram;
    LightSources mSources;
    std::optional<Light> mLight;
    bool mHasCube = false;
    vk::Buffer mRadiance;     // 6 F² × vec3
    vk::Buffer mCoefficients; // 6 F² × vec3
    vk::Buffer mTable, mStats, mWeights;
    uint64_t mRecording = 0, mRecordingBefore = 0;
};

} // namespace relume

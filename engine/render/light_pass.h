// Light change, first half: turns a light into the quantized light entries by which relighting multiplies
// transport. All of it stays on the device: sample → radiance → Haar → coefficients → quantize → table.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/render/light_sources.h"

#include <optional>

namespace relume {

struct LightStats {
    float scale;                     // LightVector::scale
    float error;                     // LightVector::error
    uint32_t kept;                   // entries
    std::optional<uint32_t> changed; // entries that differ from the light recorded before; none if unknown
};

// Samples, transforms, selects and quantizes light. Keeps a reference to the device, which must outlive it.
class LightPass {
  public:
    // `faceSize` is F of the asset, 32 or 64 (any even power of two up to 64 works).
    LightPass(const vk::Device& device, int faceSize);

    // Sets the light of the record() calls that follow. Sources, at most kMostSources of a kind, are sampled
    // anew by every record(). Maps of environments that the light before did not have are uploaded, which
    // waits; maps are identified by their pointers, and kept alive until the next light. A cube, of F texels
    // a side, is used as it is.
    void setLight(Light light);
    void setEnvironment(const Environment& prepared); // as the only source
    void setCube(const LightCube& cube);

    // Records passes "light sample" (environments), "light sky", "light strokes", "light lamps", "light
    // distant" (those that there is a source for), "light haar" and "light quantize". `rotation` turns the
    // light, but not a cube, by radians as turned() does. Compute and draws may use the results at once.
    // Submit recordings once, in order: the table has the changes since the recording before.
    void record(vk::Commands& commands, float rotation = 0, const LightSelection& selection = {});

    int faceSize() const { return mFaceSize; }
    // Returns 6 F² × shared::PackedLight, zero where dropped, then as many differences from the light before.
    const vk::Buffer& table() const { return mTable; }
    const vk::Buffer& stats() const { return mStats; }       // shared::LightStats
    const vk::Buffer& radiance() const { return mRadiance; } // 6 F² × vec3

    // Return the numbers of the last record() and the one before, from 1 over all light passes; 0 for none.
    uint64_t recording() const { return mRecording; }
    uint64_t recordingBefore() const { return mRecordingBefore; }

    // Returns statistics of the last submission of record(). Waits for the device.
    LightStats readStats() const;

    // Return results of the last submission of record(), for tests and `relume verify`. Wait for the device.
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

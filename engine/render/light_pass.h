// Light change, first half: a light becomes the quantised coefficients that relighting multiplies with.
// Everything stays on the device: sample → radiance → Haar → coefficients → quantise → table.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/render/light_sources.h"

namespace relume {

struct LightStats {
    float scale;   // LightVector::scale
    float error;   // LightVector::error
    uint32_t kept; // entries
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
    // (where there are any), "light haar", "light quantise". `rotation` in radians turns the light, as
    // turned() does, but not a cube. Compute and draws may use the results at once.
    void record(vk::Commands& commands, float rotation = 0, const LightSelection& selection = {}) const;

    int faceSize() const { return mFaceSize; }
    const vk::Buffer& table() const { return mTable; } // 6 F² × shared::PackedLight, zero where dropped
    const vk::Buffer& stats() const { return mStats; } // shared::LightStats

    // What selection and quantisation cost in the last submission of record(). Waits for the device.
    LightStats readStats() const;

    // What the last submission of record() left, for tests and `relume verify`. They wait for the device.
    LightCube readCube() const;
    LightVector readVector() const;

  private:
    uint32_t coefficients() const { return 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize); }

    const vk::Device& mDevice;
    int mFaceSize;
    vk::ComputeProgram mHaarProgram, mQuantiseProgram;
    LightSources mSources;
    std::optional<Light> mLight;
    bool mHasCube = false;
    vk::Buffer mRadiance;     // 6 F² × vec3
    vk::Buffer mCoefficients; // 6 F² × vec3
    vk::Buffer mTable, mStats;
};

} // namespace relume

// Light change, first half: a light becomes the quantised coefficients that relighting multiplies with.
// Everything stays on the device: sample → radiance → Haar → coefficients → quantise → table.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/vk/commands.h"

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

    // The light of the record() calls that follow. A prepared environment (prepareForSampling) is
    // sampled anew by every record(); a cube, of F texels a side, is taken as it is.
    void setEnvironment(const Environment& prepared);
    void setCube(const LightCube& cube);

    // Passes "light sample" (environments only), "light haar", "light quantise". `rotation` in radians,
    // as in sampleEnvironment(), turns an environment, not a cube. Compute and draws may use the
    // results at once.
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
    vk::ComputeProgram mSampleProgram, mHaarProgram, mQuantiseProgram;
    bool mHasLight = false;
    bool mSamplesEnvironment = false;
    ivec2 mEnvironmentSize{0};
    vk::Buffer mEnvironment;                       // vec3 per pixel of the latlong map
    vk::Buffer mFootprintStarts, mFootprintPixels; // LightFootprints
    vk::Buffer mRadiance;                          // 6 F² × vec3
    vk::Buffer mCoefficients;                      // 6 F² × vec3
    vk::Buffer mTable, mStats;
};

} // namespace relume

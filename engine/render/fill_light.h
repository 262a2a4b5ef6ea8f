// The light without its key on the device, beside the whole light of a light pass: what shading needs to
// estimate the shadows of each on their own (docs/residual.md).
#pragma once

#include "engine/render/light_pass.h"

namespace relume {

class FillLight {
  public:
    FillLight(const vk::Device& device, int faceSize);

    // Records passes "light fill", "fill haar" and "fill quantize", of the light recorded before.
    void record(vk::Commands& commands, const LightPass& light);

    const LightTable& table() const { return mTable; }
    const vk::Buffer& radiance() const { return mRadiance; } // 6 F² × vec3

    // Returns the fill of the last submission of record(), for tests. Waits for the device.
    LightCube readCube() const;

  private:
    const vk::Device& mDevice;
    int mFaceSize;
    vk::ComputeProgram mProgram;
    LightTable mTable;
    vk::Buffer mRadiance;
};

} // namespace relume

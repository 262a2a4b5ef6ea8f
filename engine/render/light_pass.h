// Light change, first half: turns a light into the quantized light entries by which relighting multiplies
// transport. All of it stays on the device: sample → radiance → Haar → coefficients → quantize → table.
#pragma once

#include "engine/render/light_sources.h"
#include "engine/render/light_table.h"

#include <optional>

namespace relume {

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
    const LightTable& table() const { return mTable; }       // the light's entries
    const vk::Buffer& radiance() const { return mRadiance; } // 6 F² × vec3
    // Returns the selection of the last record().
    const LightSelection& selection() const { return mSelection; }

    // Returns statistics of the last submission of record(). Waits for the device.
    LightStats readStats() const { return mTable.readStats(); }

    // Return results of the last submission of record(), for tests and `relume verify`. Wait for the device.
    LightCube readCube() const;
    LightVector readVector() const { return mTable.readVector(); }

  private:
    uint32_t coefficients() const { return 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize); }

    const vk::Device& mDevice;
    int mFaceSize;
    LightSources mSources;
    LightTable mTable;
    LightSelection mSelection;
    std::optional<Light> mLight;
    bool mHasCube = false;
    vk::Buffer mRadiance; // 6 F² × vec3
};

} // namespace relume

// What lights, summed into the lighting cube on the device: the first passes of LightPass.
#pragma once

#include "engine/light/light.h"
#include "engine/vk/commands.h"

namespace relume {

class LightSources {
  public:
    LightSources(const vk::Device& device, int faceSize);

    // Uploads the maps of `light`'s environments, unless the last light had them; those are kept alive.
    // Waits. Throws Error for a map of more pixels than the device reads of a buffer.
    void prepare(const Light& light);

    // Writes 6 F² × vec3 of `radiance`. The environments' maps are among those prepared; all else travels
    // with the commands. What comes next must wait for compute, and compute for what came before.
    void record(vk::Commands& commands, const Light& light, const vk::Buffer& radiance) const;

  private:
    struct Footprints {
        ivec2 mapSize;
        vk::Buffer starts, pixels; // LightFootprints
    };
    struct Map {
        std::shared_ptr<const Environment> environment;
        vk::Buffer pixels; // vec4 each
        std::shared_ptr<const Footprints> footprints;
    };

    uint32_t texels() const { return 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize); }
    Map upload(std::shared_ptr<const Environment> environment, const std::vector<Map>& others) const;
    void sample(vk::Commands& commands, const EnvironmentLight& environment, bool isFirst,
                const vk::Buffer& radiance) const;
    void addSky(vk::Commands& commands, const DaySky& sky, const vk::Buffer& radiance) const;
    void paint(vk::Commands& commands, const std::vector<Stroke>& strokes, const vk::Buffer& radiance) const;
    void addLamps(vk::Commands& commands, const std::vector<Lamp>& lamps, const vk::Buffer& radiance) const;
    void addDistant(vk::Commands& commands, const std::vector<DistantLight>& distant,
                    const vk::Buffer& radiance) const;

    const vk::Device& mDevice;
    int mFaceSize;
    vk::ComputeProgram mSampleProgram, mSkyProgram, mStrokesProgram, mLampGainsProgram, mLampsProgram,
        mDistantProgram;
    std::vector<Map> mMaps;
    vk::Buffer mStrokes, mLamps; // (kMostSources + 1) × shared::LightCap: the sun is a lamp too
    vk::Buffer mLampGains;       // (kMostSources + 1) × float
    vk::Buffer mTaps;            // 4 kMostSources × shared::LightTap
};

} // namespace relume

// The sum of light sources as a lighting cube on the device: the first passes of LightPass.
#pragma once

#include "engine/light/light.h"
#include "engine/vk/commands.h"

namespace relume {

// Sums light sources. Keeps a reference to the device, which must outlive it.
class LightSources {
  public:
    LightSources(const vk::Device& device, int faceSize);

    // Uploads the maps of `light`'s environments, except those that the light before had, and keeps them
    // alive. Waits. Throws Error for a map of more pixels than the device can read from a buffer.
    void prepare(const Light& light);

    // Records the writing of `radiance`, 6 F² × vec3. The environments' maps must be prepared; other sources
    // travel with the commands. The caller adds the barriers: this waits for earlier compute, and readers
    // wait for this.
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

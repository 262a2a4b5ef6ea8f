// What the last frames spent their time on.
#pragma once

#include "engine/vk/commands.h"

#include <array>
#include <chrono>

namespace relume {

class FrameTimes {
  public:
    static constexpr size_t kFrames = 120;

    // A frame that took `seconds` from its input to its image, and passes of it.
    void add(double seconds, const vk::PassTimes& passes);

    // Milliseconds of the last frames, the newest last.
    std::vector<float> milliseconds() const;
    // Of every pass that some frame had, the newest.
    struct Pass {
        std::string name;
        double seconds;
        uint64_t frame; // that had it; isOfLastFrame()
    };
    const std::vector<Pass>& passes() const { return mPasses; }
    bool isOfLastFrame(const Pass& pass) const { return pass.frame == mCount; }
    // If frames followed each other: by those of the last second of drawing.
    double framesPerSecond() const;

  private:
    std::array<float, kFrames> mSeconds{};
    uint64_t mCount = 0;
    std::vector<Pass> mPasses;
};

} // namespace relume

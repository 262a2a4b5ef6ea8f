// Statistics of the times of recent frames.
#pragma once

#include "engine/vk/commands.h"

#include <array>
#include <chrono>

namespace relume {

class FrameTimes {
  public:
    static constexpr size_t kFrames = 120;

    // Adds a frame that took `seconds` from its input to its image, and the times of its passes.
    void add(double seconds, const vk::PassTimes& passes);

    // Returns the times of the last frames, newest last.
    std::vector<float> milliseconds() const;
    // The newest time of every pass that any frame had.
    struct Pass {
        std::string name;
        double seconds;
        uint64_t frame; // that had it last
    };
    const std::vector<Pass>& passes() const { return mPasses; }
    bool isOfLastFrame(const Pass& pass) const { return pass.frame == mCount; }
    // Returns the rate at which frames could follow each other, from the last second of drawing.
    double framesPerSecond() const;

  private:
    std::array<float, kFrames> mSeconds{};
    uint64_t mCount = 0;
    std::vector<Pass> mPasses;
};

} // namespace relume

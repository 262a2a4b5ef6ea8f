#include "apps/viewer/frame_times.h"

#include <algorithm>

namespace relume {

void FrameTimes::add(double seconds, const vk::PassTimes& passes) {
    mSeconds[mCount++ % kFrames] = float(seconds);
    for (const auto& [name, time] : passes) {
        const auto known = std::ranges::find(mPasses, name, &Pass::name);
        if (known == mPasses.end())
            mPasses.push_back({name, time, mCount});
        else
            *known = {name, time, mCount};
    }
}

std::vector<float> FrameTimes::milliseconds() const {
    std::vector<float> times;
    for (uint64_t i = mCount - std::min<uint64_t>(mCount, kFrames); i < mCount; i++)
        times.push_back(1e3f * mSeconds[i % kFrames]);
    return times;
}

double FrameTimes::framesPerSecond() const {
    double sum = 0;
    uint64_t frames = 0;
    while (frames < std::min<uint64_t>(mCount, kFrames) && sum < 1)
        sum += double(mSeconds[(mCount - 1 - frames++) % kFrames]);
    return sum > 0 ? double(frames) / sum : 0;
}

} // namespace relume

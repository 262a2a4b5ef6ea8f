// Progress of work that many threads share.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace relume {

// Tells of the share that is done, from `first` to `last`, now and then, from one thread at a time.
class SharedProgress {
  public:
    // Refers to `tell`, which may be empty.
    SharedProgress(const std::function<void(double)>& tell, double first, double last, size_t count)
        : mTell(tell), mFirst(first), mLast(last), mCount(count) {}

    // One more of `count` is done.
    void add() {
        if (!mTell) return;
        const std::lock_guard lock(mMutex);
        mDone++;
        if (mDone % 16 == 0 || mDone == mCount)
            mTell(mFirst + (mLast - mFirst) * double(mDone) / double(mCount));
    }

  private:
    const std::function<void(double)>& mTell;
    double mFirst, mLast;
    size_t mCount, mDone = 0;
    std::mutex mMutex;
};

} // namespace relume

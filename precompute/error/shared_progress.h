// Progress of work shared by many threads.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace relume {

// Calls a function with the share done, from `first` to `last`, now and then and from one thread at a time.
class SharedProgress {
  public:
    // Keeps a reference to `tell`, which may be empty.
    SharedProgress(const std::function<void(double)>& tell, double first, double last, size_t count)
        : mTell(tell), mFirst(first), mLast(last), mCount(count) {}

    // Counts one more of `count` pieces as done.
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

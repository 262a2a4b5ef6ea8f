#include "apps/viewer/worker.h"

#include "engine/base/error_message.h"

namespace relume {

Worker::Worker(std::function<void()> wake)
    : mWake(std::move(wake)), mThread([this](std::stop_token stop) { run(stop); }) {}

Worker::~Worker() {
    mThread.request_stop();
    mThread.join();
}

void Worker::post(std::string title, std::function<Result()> work,
                  std::function<void(const std::string&)> onError) {
    {
        const std::lock_guard lock(mMutex);
        mWaiting.push_back({std::move(title), std::move(work), std::move(onError)});
    }
    mChanged.notify_one();
}

void Worker::apply() {
    std::vector<Result> results;
    {
        const std::lock_guard lock(mMutex);
        results.swap(mResults);
    }
    for (const Result& result : results) result();
}

std::string Worker::title() const {
    const std::lock_guard lock(mMutex);
    if (!mInHand.empty()) return mInHand;
    return mWaiting.empty() ? "" : mWaiting.front().title;
}

bool Worker::isIdle() const {
    const std::lock_guard lock(mMutex);
    return mInHand.empty() && mWaiting.empty() && mResults.empty();
}

void Worker::wait() {
    std::unique_lock lock(mMutex);
    mDone.wait(lock, [&] { return mInHand.empty() && mWaiting.empty(); });
}

void Worker::run(std::stop_token stop) {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mMutex);
            if (!mChanged.wait(lock, stop, [&] { return !mWaiting.empty(); })) return;
            job = std::move(mWaiting.front());
            mWaiting.pop_front();
            mInHand = job.title;
        }
        Result result;
        try {
            result = job.work();
        } catch (const std::exception& failure) {
            result = [onError = job.onError, text = std::string(errorMessage(failure))] { onError(text); };
        }
        {
            const std::lock_guard lock(mMutex);
            mResults.push_back(std::move(result));
            mInHand.clear();
        }
        mDone.notify_all();
        mWake();
    }
}

} // namespace relume

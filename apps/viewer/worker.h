// Work beside the frames: reading files, making things of them.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace relume {

// One thread that does one piece of work after the other.
class Worker {
  public:
    // What is left to do where the results belong, on the thread that draws.
    using Result = std::function<void()>;

    // `wake` is called, from the thread, whenever a result is there.
    explicit Worker(std::function<void()> wake);
    // Drops what has not begun, and waits for what has.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    // `title` is for people: "reading bunny.obj". An exception is left to `onError`, with its text.
    void post(std::string title, std::function<Result()> work,
              std::function<void(const std::string&)> onError);

    // Runs the results that are there.
    void apply();

    // Of the work in hand, else of what waits; empty: none.
    std::string title() const;
    bool isIdle() const;
    // Until nothing is in hand and nothing waits.
    void wait();

  private:
    struct Job {
        std::string title;
        std::function<Result()> work;
        std::function<void(const std::string&)> onError;
    };
    void run(std::stop_token stop);

    std::function<void()> mWake;
    mutable std::mutex mMutex;
    std::condition_variable_any mChanged, mDone;
    std::deque<Job> mWaiting;
    std::vector<Result> mResults;
    std::string mInHand;
    std::jthread mThread; // last: it uses all of the above
};

} // namespace relume

// Background work, such as reading files.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace relume {

// A thread that does one piece of work after the other.
class Worker {
  public:
    // The rest of the work, to be run on the thread that draws.
    using Result = std::function<void()>;

    // `wake` is called from the worker's thread when a result is ready.
    explicit Worker(std::function<void()> wake);
    // Drops work that has not begun and waits for the current piece.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    // Queues work. `title` is shown to the user: "reading bunny.obj". If `work` throws, `onError` gets the
    // message.
    void post(std::string title, std::function<Result()> work,
              std::function<void(const std::string&)> onError);

    // Runs the results that are ready, or their `onError`.
    void apply();

    // Returns the title of the current work, or of the next in the queue; empty if there is none.
    std::string title() const;
    bool isIdle() const;
    // Waits until the queue is empty and nothing is running.
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

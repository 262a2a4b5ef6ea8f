// Runs `relume bake` in a process of its own, so that its work and its failures do not affect the window.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace relume {

// The progress of a running bake.
struct BakeProgress {
    std::string stage;
    double fraction = 0;
    double secondsLeft = -1; // negative: unknown

    bool operator==(const BakeProgress&) const = default;
};

class BakeProcess {
  public:
    // Starts a bake of `input` to `output`, with previews. `options` are passed to `relume bake`. Throws
    // Error if the program `relume` is not beside this one.
    BakeProcess(const std::filesystem::path& input, const std::filesystem::path& output,
                const std::vector<std::string>& options);
    // Stops the bake and waits for its end; its checkpoint remains.
    ~BakeProcess();
    BakeProcess(const BakeProcess&) = delete;
    BakeProcess& operator=(const BakeProcess&) = delete;

    // Reads the bake's output without waiting. Returns true if `output` was written.
    bool poll();

    // Asks the bake to end; its checkpoint remains. It counts as running until a poll() finds that it ended.
    void stop();

    const std::filesystem::path& input() const { return mInput; }
    const std::filesystem::path& output() const { return mOutput; }
    const BakeProgress& progress() const { return mProgress; }
    bool isRunning() const { return mProcess > 0; }
    // Returns why the bake failed; empty if it did not.
    const std::string& failure() const { return mFailure; }

  private:
    bool take(const std::string& line);
    void end();

    std::filesystem::path mInput, mOutput;
    pid_t mProcess = -1;
    int mEvents = -1, mWords = -1; // its standard output and standard error
    std::string mPartialEvent, mSaid;
    BakeProgress mProgress;
    std::string mFailure;
};

} // namespace relume
